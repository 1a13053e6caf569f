// Compares a picture with what it ought to be.
#pragma once

#include "app/stability_cases/run_case.h"

namespace binosplat::stability {

std::uint64_t countNotFinite(const Image& image);

// Compares red, green, blue and alpha. `counts`: which tiles count; empty: all.
void compareWithTwin(PictureScore& score, const Image& image, const std::vector<glm::dvec4>& twin,
                     const std::vector<bool>& counts = {});

}  // namespace binosplat::stability
