// The cases, one by one.
#include "app/stability_cases/catalogue.h"

#include "app/stability_cases/extreme_scenes.h"
#include "app/stability_cases/families.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace binosplat::stability {

Case standAlone(std::string family, std::function<Stage()> make, std::string reason) {
    return {std::move(family), "", 0.0, std::move(make), kRounding, kPlaces, std::move(reason)};
}

std::string Case::name() const {
    return parameter.empty() ? family : fmt::format("{} {:.9g}", family, value);
}

std::vector<Case> makeCatalogue() {
    std::vector<Case> cases;
    std::vector<Family> families = makeDiscFamilies();
    std::ranges::move(makeGaussianFamilies(), std::back_inserter(families));
    for (const Family& family : families) {
        for (const double value : family.values) {
            const bool beyond = value < family.told_from || value > family.told_to;
            cases.push_back({family.name, family.parameter, value,
                             [value, make = family.make] { return make(value); },
                             beyond ? family.beyond : family.rendered, beyond ? family.beyond : family.moved,
                             family.reason, beyond});
        }
    }
    for (const glm::uvec2 size_px :
         {glm::uvec2(1, 1), glm::uvec2(17, 33), glm::uvec2(1, 700), glm::uvec2(4096, 4096)}) {
        cases.push_back(standAlone(
            fmt::format("image of {}x{}", size_px.x, size_px.y), [size_px] { return makeImage(size_px); },
            "from one pixel to more than a headset's, with odd sizes that cut tiles"));
        cases.back().large = size_px.x >= 4096;
    }
    cases.push_back(standAlone("equal depths", makeEqualDepths,
                               "ties are broken by the order of the scene, so nothing is left to rounding"));
    cases.push_back(standAlone("empty scene", makeEmpty, "only the background is visible"));
    cases.push_back(standAlone("every tile covered", makeCovered, "a hundred discs touch every tile"));
    cases.push_back(standAlone("eye inside a cloud", makeCloud,
                               "discs of all sizes around the eye, through it and through the near plane"));
    cases.back().moved = kPlacesOfCut;
    addGaussianCases(cases);
    return cases;
}

}  // namespace binosplat::stability
