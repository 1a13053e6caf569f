// lod-meta.json of a streamed SOG scene, as PlayCanvas specifies it (developer.playcanvas.com, "The Streamed
// SOG Format", version 1): which splats of each chunk make up each level of detail.
#pragma once

#include "engine/files/lod_tree.h"
#include "engine/files/sog_meta.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace binosplat {

// Level 0 is the finest.
struct LodLevel {
    std::uint64_t splats = 0;
    // Keys are indices into LodMeta::files. Ranges ascend, and no two overlap or touch.
    std::map<std::size_t, std::vector<SplatRange>> chunks;
};

struct LodMeta {
    // The meta.json or .sog bundle of each chunk, relative to the folder of lod-meta.json and within it.
    std::vector<std::string> files;
    std::string environment;       // likewise, for splats that belong to every level; empty: none
    std::vector<LodLevel> levels;  // at least one
    bool has_errors = false;       // each leaf has LodLeaf::errors
    std::vector<LodLeaf> tree;     // its leaves that have splats
    std::uint64_t leaves = 0;      // all of them
    // For each level: leaves with splats at other levels but not at this one.
    std::vector<std::uint64_t> leaves_without;
    // Those of them that have a coarser level: the next coarser one is used instead.
    std::vector<std::uint64_t> leaves_coarser;
};

// `place` is the file's name for messages. Throws Error naming the key and what was expected. The reader
// checks that chunks have as many splats as the ranges say.
LodMeta parseLodMeta(std::span<const std::byte> text, const std::string& place);

}  // namespace binosplat
