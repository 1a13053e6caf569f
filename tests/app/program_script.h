// Scripts that run the program.
#pragma once

#include "app/scores/metrics.h"
#include "engine/picture/image_io.h"
#include "tests/run_program.h"

namespace binosplat::test {

// Makes the Nth call of a kind fail, or raises a signal with it (tests/faults).
inline const std::string kFault = "VK_ADD_LAYER_PATH='" BINOSPLAT_FAULT_LAYER
                                  "' VK_INSTANCE_LAYERS=VK_LAYER_BINOSPLAT_faults BINOSPLAT_FAULT=";
inline std::string fault(const std::string& call, int number, const std::string& what) {
    return fmt::format("{}{}:{}:{}", kFault, call, number, what);
}

inline ScriptHost programIn(const Workplace& work) {
    const std::string no_driver =
        "VK_DRIVER_FILES=/nonexistent/none.json VK_ICD_FILENAMES=/nonexistent/none.json";
    ScriptHost host{[&](const std::string& words, const std::string& environment) {
                        return work.run(words, environment);
                    },
                    work.path,
                    "binosplat: ",
                    {{"SOURCE", BINOSPLAT_SOURCE_DIR},
                     {"PROGRAM", BINOSPLAT_PROGRAM},
                     {"WORK", work.path.string()},
                     {"BASE", work.base.string()},
                     {"DISPLAYED", extensionOf(PictureKind::kDisplay)},
                     {"FLOAT", BINOSPLAT_FLOAT_EXTENSION},
                     {"FAULT", kFault},
                     {"NO_DRIVER", no_driver}}};
#ifdef BINOSPLAT_SOG
    host.features.insert("sog");
#endif
#ifdef BINOSPLAT_OPENXR
    host.features.insert("openxr");
#endif
#ifdef BINOSPLAT_HAS_PNG
    host.features.insert("png");
#endif
    // psnr FIRST SECOND > DB, of pictures as they are displayed.
    host.verbs["psnr"] = [&](const std::string& line) {
        const std::vector<std::string> words = wordsIn(line);
        const auto picture = [&](std::size_t i) {
            return readPicture(work.path / (words.at(i) + extensionOf(PictureKind::kDisplay)));
        };
        const double db = compare(picture(0), picture(1)).psnrDb(), bound_db = std::stod(words.at(3));
        CAPTURE(db);
        CHECK((words[2] == ">" ? db > bound_db : db < bound_db));
    };
    return host;
}

inline void runProgramScript() {
    const Workplace work;
    runScript(programIn(work));
}

}  // namespace binosplat::test
