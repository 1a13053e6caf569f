// How the program understands a command line.
#pragma once

#include "app/options/options.h"
#include "engine/scene/scene.h"
#include "tests/suite.h"

#include <variant>

namespace binosplat::test {

inline Options parseWords(const std::vector<std::string>& words) {
    std::vector<const char*> arguments{"binosplat"};
    for (const std::string& word : words) { arguments.push_back(word.c_str()); }
    return parseOptions(static_cast<int>(arguments.size()), arguments.data());
}

// A line without quotes.
inline Options parseLine(const std::string& line) {
    std::istringstream words(line);
    return parseWords({std::istream_iterator<std::string>(words), {}});
}

template <typename Chosen>
Chosen parse(const std::string& line) {
    return std::get<Chosen>(parseLine(line));
}

inline const std::string kRenderOne = "render builtin:one-splat --out out ";

inline RunOptions renderOptions(const std::string& options) {
    return parse<RenderOptions>(kRenderOne + options).run;
}

// A scene that fills the box from (-1, -2, -3) to (1, 2, 3).
inline Scene makeBox(const std::string& name) {
    Scene scene;
    scene.name = name;
    for (int i = 0; i <= 100; ++i) {
        const float t = static_cast<float>(i) / 50.0f - 1.0f;
        scene.positions.emplace_back(t, 2.0f * t, 3.0f * t);
    }
    return scene;
}

}  // namespace binosplat::test
