// The scenes that were shown last, latest first, and the favourites, kept from one run of the viewer to the
// next.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace binosplat {

inline constexpr std::size_t kMostRecentScenes = 10;

// From the user's configuration folder; empty if nothing has been saved or it cannot be read.
std::vector<std::string> recentScenes();

// Puts `scene` first, with its full path, and saves the list atomically. Throws Error if that fails.
void rememberScene(const std::string& scene);

// The scenes that the wearer marked, in the order of marking.
std::vector<std::string> favouriteScenes();
// The favourites, and then the recent ones that are not among them.
std::vector<std::string> favouriteAndRecentScenes();
// Marks or unmarks `scene`. Throws Error if that cannot be saved.
void toggleFavourite(const std::string& scene);

// `scenes` with `scene` first, and only once.
std::vector<std::string> withLatest(std::vector<std::string> scenes, const std::string& scene);

}  // namespace binosplat
