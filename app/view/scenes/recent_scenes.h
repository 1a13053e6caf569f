// The scenes that were shown last, the latest first, and the favourites, from one run of the viewer to the next.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace binosplat {

inline constexpr std::size_t kMostRecentScenes = 10;

// As the user's configuration folder keeps them; none where nothing is kept or it cannot be read.
std::vector<std::string> recentScenes();

// Puts `scene` first, its path in full, and keeps the list, whole or as it was. Throws Error where it cannot be kept.
void rememberScene(const std::string& scene);

// Those that the wearer marked, in the order in which that was done.
std::vector<std::string> favouriteScenes();
// Marks `scene`, or no longer. Throws Error where it cannot be kept.
void toggleFavourite(const std::string& scene);

// The same on a list alone: a scene stands in it once.
std::vector<std::string> withLatest(std::vector<std::string> scenes, const std::string& scene);

}  // namespace binosplat
