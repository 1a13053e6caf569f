// `binosplat bench`, its kinds, and their common parts.
#pragma once

#include "app/bench/bench_plan.h"

namespace binosplat {

// Throws Error.
void runBench(const BenchOptions& options);

// Reports a missing scene before the others are measured. Throws Error naming it.
void requireScenes(const BenchPlan& plan);

// `bench --motion`: every method at every pose of a recorded head; error, time and flicker. Writes
// motion.csv, .json and .svg.
void benchMotion(const BenchOptions& options, const BenchPlan& plan);

// `bench --photos`: compares the affiliated eye, placed where a photograph was taken, with the photograph.
// Writes photos.csv and .json.
void benchPhotos(const BenchOptions& options, const BenchPlan& plan);

// `bench --orders`: compares pictures with each order of splats with one in which every pixel has its own
// order, and measures popping while the head turns; only on the CPU, for the plan's scenes, views and first
// size. Writes orders.csv.
void benchOrders(const BenchOptions& options, const BenchPlan& plan);

}  // namespace binosplat
