// split_scene SCENE FOLDER [LEAF_SPLATS [LEVELS [CHUNK_SPLATS]]]: makes a streamed SOG scene from a whole
// one, for trying streaming.
#include "engine/error.h"
#include "engine/files/load_scene.h"
#include "tests/engine/stream/split_scene.h"

#include <cstdio>

int main(int argc, char** argv) {
    using namespace binosplat;
    if (argc < 3 || argc > 6) {
        fmt::print(stderr, "usage: split_scene SCENE FOLDER [LEAF_SPLATS [LEVELS [CHUNK_SPLATS]]]\n");
        return 2;
    }
    try {
        test::SplitSettings settings;
        const auto take = [&](int index, std::uint32_t& value, unsigned long most) {
            if (argc <= index) { return; }
            const unsigned long given = std::stoul(argv[index]);
            check(given >= 1 && given <= most, "{}: must be 1 to {}", argv[index], most);
            value = static_cast<std::uint32_t>(given);
        };
        take(3, settings.leaf_splats, 1u << 24);
        take(4, settings.levels, 16);
        take(5, settings.chunk_splats, 1u << 24);
        test::splitScene(loadScene(std::string(argv[1])), argv[2], settings);
        return 0;
    } catch (const std::exception& error) {
        fmt::print(stderr, "split_scene: {}\n", error.what());
        return 1;
    }
}
