// Constants that shape the code, each with its reason.
#ifndef BINOSPLAT_SHADERS_SHARED_CONSTANTS_H
#define BINOSPLAT_SHADERS_SHARED_CONSTANTS_H

#include "language.h"

BINOSPLAT_BEGIN_SHARED

// Tiles are the unit of binning and of patching; the 16x16 of 3DGS and 2DGS (Kerbl et al. 2023, section 6).
BINOSPLAT_CONSTANT uint kTileSize = 16;
// Columns and rows of tiles, at most: lib/tile_set.glsl has ten bits for each.
BINOSPLAT_CONSTANT uint kMostTilesAcross = 1024;
// Cells are the quarters of a tile that one subgroup owns while blending, so that a splat only costs the
// cells it touches.
BINOSPLAT_CONSTANT uint kCellSize = 8;
BINOSPLAT_CONSTANT uint kCellsPerTile = 4;
// Splats of a tile that are loaded into shared memory at a time: 128 x 56 bytes = 7 KiB, so that eight or
// more workgroups fit into the shared memory of a GPU core; a multiple of 32, since each splat has one bit
// that says which cells it touches.
BINOSPLAT_CONSTANT uint kBatchSize = 128;

// Threads per workgroup where each thread handles one item: as many as every device supports, and one
// subgroup on the widest.
BINOSPLAT_CONSTANT uint kGroupSize = 128;
// Splats of the scene that a workgroup culls or compacts, and items of a list that one projects or bins.
// Several per thread: the last workgroup then has few counts to sum, and the eye is loaded into shared memory
// less often.
BINOSPLAT_CONSTANT uint kCullBlock = 512;
BINOSPLAT_CONSTANT uint kListBlock = 256;
// Splats that are loaded and dropped together: as many as one workgroup culls.
BINOSPLAT_CONSTANT uint kPageSplats = kCullBlock;

// Sorting: up to 9 bits per round. A block is what one workgroup ranks: kSortSubgroups subgroups if they are
// narrow, more if they are wide (engine/passes/sort.cpp), each with a histogram in shared memory. Beyond half
// a million keys, blocks grow. Counts are summed in two steps, by runs of kSortRun blocks and then over the
// runs, each step a few loads per thread.
BINOSPLAT_CONSTANT uint kMaxDigitBits = 9;
BINOSPLAT_CONSTANT uint kMaxDigits = 1 << kMaxDigitBits;
BINOSPLAT_CONSTANT uint kSortBlock = 2048;
BINOSPLAT_CONSTANT uint kMaxSortBlocks = 256;
BINOSPLAT_CONSTANT uint kSortRun = 16;
BINOSPLAT_CONSTANT uint kMaxSortRuns = kMaxSortBlocks / kSortRun;
BINOSPLAT_CONSTANT uint kSortSubgroups = 4;

// The last workgroup sums the counts of all, 1024 at a time. Beyond four times that, runs of them are first
// summed side by side: as many runs as a list has counters of kSumRunBits bits, ListState::run_groups_done.
BINOSPLAT_CONSTANT uint kMostInOneRun = 4096;
BINOSPLAT_CONSTANT uint kSumRuns = 8;
BINOSPLAT_CONSTANT uint kSumRunBits = 16;
// For cull_pages, whose last workgroup also lists the pages, with a word of 32 per thread: pages in
// workgroups of kGroupSize.
BINOSPLAT_CONSTANT uint kMostPageGroupsInOneRun = 32;

// Keys of depths and distances, for three rounds: each float between half the near plane and 2^13 times the
// near plane has a key of its own. Nearer (and behind the eye) 2^kNearKeyShift floats share a key, farther
// away 2^kFarKeyShift.
BINOSPLAT_CONSTANT uint kDepthKeyBits = 27;
BINOSPLAT_CONSTANT uint kExactDepthKeys = 14 << 23;
BINOSPLAT_CONSTANT uint kNearKeyShift = 10;
BINOSPLAT_CONSTANT uint kFarKeyShift = 8;

// newcomers: visible splats that a workgroup examines; few of them are seen by only one eye.
BINOSPLAT_CONSTANT uint kNewcomersBlock = 1024;

// No list is longer: SPIR-V treats array indices as signed.
BINOSPLAT_CONSTANT uint kMaxItems = 0x7fffffffu;

// A dispatch of more groups than this is folded into rows: 65535 is what every device allows along one axis.
BINOSPLAT_CONSTANT uint kMaxGroupsX = 32768;

// A scene's splats are discs (2DGS) or 3D Gaussians.
BINOSPLAT_CONSTANT uint kDiscs = 0;
BINOSPLAT_CONSTANT uint kGaussians = 1;
// The low-pass of 3DGS: this much variance is added on the screen, in px^2 (Kerbl et al. 2023, the reference
// implementation).
BINOSPLAT_CONSTANT float kScreenVariance = 0.3f;
// The projection's derivative is taken within the picture enlarged by this fraction of its width and height
// on each side: near the eye the linear projection breaks down (the same reference implementation).
BINOSPLAT_CONSTANT float kDerivativeBorder = 0.15f;
// The depth of a 3D Gaussian at a pixel is extrapolated linearly from its centre; it stays within this ratio
// of the centre's.
BINOSPLAT_CONSTANT float kDepthReach = 2.0f;
// The axes of a 3D Gaussian are cut off at this length on the screen, in px, so that their squares and the
// areas between them stay finite: if an axis is that long, the visible part is equally opaque everywhere
// along it.
BINOSPLAT_CONSTANT float kMaxSigma = 1e15f;

// Alpha is never above this, and hits below 1/255 are skipped; blending stops before the transmittance would
// fall below kMinTransmittance (Kerbl et al. 2023, appendix C). kMinPassing is a constant of its own: 1 -
// 0.99f is 0.01 to six digits only, and two such hits leave exactly 1e-4, which is not below it.
BINOSPLAT_CONSTANT float kMaxAlpha = 0.99f;
BINOSPLAT_CONSTANT float kMinAlpha = 1.0f / 255.0f;
// rho at which an opacity of 1 falls to kMinAlpha, 2 ln 255, plus a small margin: no splat reaches farther.
BINOSPLAT_CONSTANT float kMaxCut = 11.083f;
BINOSPLAT_CONSTANT float kMinPassing = 0.01f;
BINOSPLAT_CONSTANT float kMinTransmittance = 1e-4f;
BINOSPLAT_CONSTANT float kLog2Of255 = 7.99435343685886f;
// rho is in units of exp(-rho/2): exp(-rho/2) = exp2(-kLog2PerRho rho).
BINOSPLAT_CONSTANT float kLog2PerRho = 0.72134752044448f;
// The low-pass of 2DGS: rho2 = kLowPass * squared distance in pixels, that is sigma = sqrt(2)/2 px (Huang et
// al. 2024, section 4.2).
BINOSPLAT_CONSTANT float kLowPass = 2.0f;

// A disc whose plane passes the eye within this sine is seen edge-on: float32 can no longer tell which side
// is seen, and even a disc a thousand pixels long is thinner than 1/1000 px. What is left of it is the
// low-pass.
BINOSPLAT_CONSTANT float kEdgeOnSine = 3e-7f;
// plane_from_pixel is cut off here, at a disc of 1e-15 px, so that its squares stay finite.
BINOSPLAT_CONSTANT float kMaxPlaneSlope = 1e15f;
// Outlines are widened by this many pixels: a hundred times the rounding of a coordinate in an image of 2048
// px.
BINOSPLAT_CONSTANT float kOutlinePadding = 1.0f / 64.0f;

// The depth that the reprojection takes for a pixel: D as the paper writes it, D/A, or A/I, from the mean
// disparity.
BINOSPLAT_CONSTANT uint kDepthSum = 0;
BINOSPLAT_CONSTANT uint kDepthMean = 1;
BINOSPLAT_CONSTANT uint kDepthInverse = 2;

// How a pixel of the target came about, before patching.
BINOSPLAT_CONSTANT uint kCovered = 0;
BINOSPLAT_CONSTANT uint kGap = 1;
BINOSPLAT_CONSTANT uint kHole = 2;

// Why a tile of the target is rendered; 0: it is not, its pixels are reprojected.
BINOSPLAT_CONSTANT uint kTileEdge = 1;
BINOSPLAT_CONSTANT uint kTileCenter = 2;
BINOSPLAT_CONSTANT uint kTilePredicted = 3;
// Neither rendered nor reprojected: no lens shows it, so it stays background, without splats or errors.
BINOSPLAT_CONSTANT uint kTileHidden = 4;
// Rendered because that is cheaper than reprojecting its pixels.
BINOSPLAT_CONSTANT uint kTileCheap = 5;

// The cost of rendering a tile beyond its pairs, in pairs: starting a workgroup and writing 256 pixels.
BINOSPLAT_CONSTANT uint kTilePairs = 16;
// Warping has a cost even if no tile is warped, since rasterize and resample, or reproject and resample,
// process all pixels: the cost of warping all tiles, divided by this.
BINOSPLAT_CONSTANT uint kMoveSharedPart = 2;
// If nothing was warped in the frame before, one part in this many of what warping saves does not count.
BINOSPLAT_CONSTANT uint kResumePart = 8;

// The price list of price: bins of 1/16 octave of expected error per pair, from 2^-23 steps upwards; more
// than any quotient of two words needs.
BINOSPLAT_CONSTANT uint kPriceBins = 1024;
// Under a bound, the upper half is for tiles that are expected to exceed it, and the last bin for those that
// the history did not see, that is for tiles with fewer than this share of their pixels seen. These are
// rendered whatever the budget, so that nothing on the screen is stretched from a border.
BINOSPLAT_CONSTANT uint kOverBin = kPriceBins / 2;
BINOSPLAT_CONSTANT uint kNewBin = kPriceBins - 1;
BINOSPLAT_CONSTANT float kNewShare = 0.25f;
// The share of an eye's work for tiles within the bound: expectations are not exact, and this gives every
// tile its turn.
BINOSPLAT_CONSTANT float kWithinBound = 0.05f;
// The highest cost of a tile in the price list, in pairs: ten bits of the word hold the bin, and one says
// that the tile would be in a higher bin if its error were seen whole.
BINOSPLAT_CONSTANT uint kMaxTileCost = 0x1fffffu;
BINOSPLAT_CONSTANT uint kSeenInPart = 0x200000u;

// The finest cycle that an eye resolves, in radians: 1/48 of a degree at its gaze, plus 0.022 (1.32 arc
// minutes per degree) times the angle from there: the more careful of the two slopes of Guenter et al. 2012,
// Foveated 3D Graphics.
BINOSPLAT_CONSTANT float kFovealCycle = 0.000363610f;
BINOSPLAT_CONSTANT float kCyclePerAngle = 0.022f;
// If the eye sees an error only in part, a tile is never rendered for it if less than this of its square is
// seen: a hundredth of the range from black to white in each of its 256 pixels, about the lowest contrast
// that people notice.
BINOSPLAT_CONSTANT float kLeastSeenError = 0.0256f;
// If the eye sees at most this share of an error, its finest cycle covers four pixels: it cannot tell two
// rows apart, and resample averages the rows above and below. price writes kSeenCoarsely in place of the
// tile's error: it is greater than any error.
BINOSPLAT_CONSTANT float kCoarseShare = 0.25f;
BINOSPLAT_CONSTANT uint kSeenCoarsely = 0xffffffffu;
// A coarse tile is blended as 8x8 samples. The outermost ones are in the middles of its outermost pixels, so
// none must be extrapolated and tiles fit each other; the others are evenly spaced between them.
BINOSPLAT_CONSTANT float kSamplesApart = float(kTileSize - 1) / float(kCellSize - 1);
// Splats of such a tile that are loaded at a time.
BINOSPLAT_CONSTANT uint kCoarseBatch = kBatchSize / kCellsPerTile;
// It is expected to have lost this fraction of the second differences of its samples, squared and summed over
// both axes and all channels. Measured on 2DGS scenes as headsets show them: docs/tried.md.
BINOSPLAT_CONSTANT float kCoarseLoss = 0.3f;
// The spread of a moving pixel's inverse depth is stored in 31 steps of half an octave, the first at 2^-13 of
// the inverse depth.
BINOSPLAT_CONSTANT uint kSpreadCodes = 31;
BINOSPLAT_CONSTANT float kLeastSpreadLog2 = -13.0f;

// resample keeps a row of arrivals in shared memory, in steps of this many pixels: 12 KiB with all that
// belongs to them, and two steps if a device has 32 KiB, which is enough for the rows of any headset. Longer
// rows are read from memory, where reproject puts their pixels, as it does for canted eyes at any length.
BINOSPLAT_CONSTANT uint kArrivalsStep = 2304;
BINOSPLAT_CONSTANT uint kMostRowSteps = 2;
// What resample makes a row from: arrivals in memory; the source's pixels; the same if the source has no
// hidden tiles, as is usual when errors are predicted; or the places at which the row above was sampled.
BINOSPLAT_CONSTANT uint kArrivalsGiven = 0;
BINOSPLAT_CONSTANT uint kRowMoved = 1;
BINOSPLAT_CONSTANT uint kWholeRowMoved = 2;
BINOSPLAT_CONSTANT uint kPlacesGiven = 3;
// And what it does: it samples colours; it also predicts errors; it copies colours; or it does any of these
// and keeps the classes of pixels, for reports and tints and for grouping holes.
BINOSPLAT_CONSTANT uint kSamples = 0;
BINOSPLAT_CONSTANT uint kPredicts = 1;
BINOSPLAT_CONSTANT uint kCopies = 2;
BINOSPLAT_CONSTANT uint kDoesAny = 3;
// Invocations of a workgroup in the passes of warp and choose: as many as every device allows.
BINOSPLAT_CONSTANT uint kWarpGroup = 128;

// warp_history: the block of pixels that a thread makes: 9x13 source pixels are read for 4x8. A workgroup
// makes the blocks of a row of tiles.
BINOSPLAT_CONSTANT uint kHistoryColumns = 4;
BINOSPLAT_CONSTANT uint kHistoryRows = 8;
BINOSPLAT_CONSTANT uint kHistoryGroup = 64;
BINOSPLAT_CONSTANT uint kHistoryTiles =
    kHistoryGroup * kHistoryColumns * kHistoryRows / (kTileSize * kTileSize);
// Depths are examined this far around a block: within a frame, a head's motion shifts near content against
// far content by less than that.
BINOSPLAT_CONSTANT uint kHistoryBorder = 2;
// Farther away, occluders are searched for along the path they would take where the near plane moves that
// far, in steps of this.
BINOSPLAT_CONSTANT float kHistorySearchStep = 8.0f;
BINOSPLAT_CONSTANT uint kHistoryMostSearched = 48;
// How far the places of a block's pixels may deviate from a common shift, and how much of that may come from
// its depths, in pixels.
BINOSPLAT_CONSTANT float kHistorySmooth = 0.0625f;
BINOSPLAT_CONSTANT float kHistorySameDepth = 0.25f;
// A pixel of the history that lands this close to the wanted place is what is seen there (half a pixel, and
// rounding).
BINOSPLAT_CONSTANT float kHistoryAgrees = 0.51f;
BINOSPLAT_CONSTANT uint kHistorySteps = 3;
// The taps of a place reach this far from its pixel.
BINOSPLAT_CONSTANT int kHistoryReach = 3;
// A pixel whose inverse depth spreads by an eighth of it blends what is in front with what is behind: it
// moves with the nearest content of the words this far around; from eye to eye, with that of itself and its
// two neighbours in the row.
BINOSPLAT_CONSTANT uint kMixedCode = 21;
BINOSPLAT_CONSTANT int kFrontReach = 2;
// The squared error, in three channels, of a pixel where the history shows nothing, and of one that a
// silhouette uncovers: the few of these resemble what is beside them, and are off by little more than the
// picture's changes suggest (measured). A quarter of a tile with this many pixels that the history did not
// see is new, and is expected to be off by that amplitude.
BINOSPLAT_CONSTANT float kUnseenError = 1.0f;
BINOSPLAT_CONSTANT float kUncoveredError = 0.001f;
BINOSPLAT_CONSTANT uint kNewPixels = 32;
BINOSPLAT_CONSTANT float kNewError = 0.5f;
// The least squared error that a warped pixel adds, (1/4000)^2 in three channels, so that every tile gets its
// turn.
BINOSPLAT_CONSTANT float kLeastGrowth = 1.9e-7f;
// What the blocks of a quarter bring along from the history, amplitudes up to 1 and their squares, is summed
// in steps of 2^-30.
BINOSPLAT_CONSTANT float kCarriedSteps = 1073741824.0f;
// The weight of the measured growth of a tile's error, from when it was last rendered; the rest is the
// model's. A quarter of a tile of which much was not seen grows only by the model.
BINOSPLAT_CONSTANT float kMeasuredShare = 0.5f;
BINOSPLAT_CONSTANT float kUnseenGrowth = 0.05f;

// Where a part of the scene came or went, an eye's history is expected to be wrong by this amplitude, and
// never by more than the second: new content often resembles the old, and a tile that was never seen is worth
// more.
BINOSPLAT_CONSTANT float kChangedError = 0.125f;
BINOSPLAT_CONSTANT float kMostChangedError = 0.5f;

// Pixels of the source this close to a tile without a picture are not reprojected: where they arrive, the
// cubic kernel reads up to two pixels beside them, and the place is up to one off.
BINOSPLAT_CONSTANT uint kHiddenMargin = 3;

// Expected squared errors are summed in fixed point, so that the sum does not depend on the order: steps of
// 2^-20. A pixel's is at most kMaxPixelError (more than black and white differ in three channels), so that a
// tile's sum stays below 2^31.
BINOSPLAT_CONSTANT float kErrorSteps = 1048576.0f;
BINOSPLAT_CONSTANT float kMaxPixelError = 4.0f;
// Squared errors of whole tiles are summed in steps of 2^-10, each at most this, so that the sum over 65,536
// tiles fits.
BINOSPLAT_CONSTANT float kSquareSteps = 1024.0f;
BINOSPLAT_CONSTANT float kMostSquares = 48.0f;
// In each frame, one tile in this many is measured for what pixels twice as wide would lose; in the next
// frame, others are. This alone predicts a picture of half the size within half a dB on most views:
// docs/tried.md.
BINOSPLAT_CONSTANT uint kMeasuredParts = 64;
BINOSPLAT_CONSTANT float kWiderLowPass = 0.25f;
// Frames; beyond them, longer waiting no longer raises a tile's weight.
BINOSPLAT_CONSTANT uint kMostWaited = 32;
// The least error of a hole's pixel, since hidden content need not look like what is next to it: (1/100)^2,
// so little that it only decides between tiles that are otherwise equal.
BINOSPLAT_CONSTANT float kLeastHoleError = 1e-4f;
// The weight of the spread of the depths that a pixel blends. The whole pixel is warped by their mean, so
// each part of it is off by how far its own depth is from that, but shows only with its own weight. All
// values from a quarter to three quarters choose equally well.
BINOSPLAT_CONSTANT float kSpreadWeight = 0.5f;
// Beyond this uncertainty in pixels, a disparity no longer causes blur: the error stops growing with it.
BINOSPLAT_CONSTANT float kMaxSpread = 4.0f;

// A splat that only one eye sees is in front of what the other saw if its inverse depth exceeds that of the
// tile's middle by this ratio: a wall that continues beyond the border is as deep as what is repeated there,
// and rounding must not decide.
BINOSPLAT_CONSTANT float kInFrontRatio = 1.01f;

// contribute sums in fixed point, so that the order of threads does not matter: steps of 2^-20. What a pixel
// adds is at most kMaxPixelError, so that a tile's sum stays within 31 bits. A splat's sums, in this order;
// or two, of which the second is w times the mean square over channels, times kSquareScale.
BINOSPLAT_CONSTANT float kContributionSteps = 1048576.0f;
BINOSPLAT_CONSTANT uint kSumWeight = 0;   // w
BINOSPLAT_CONSTANT uint kSumMissing = 1;  // w times what the pixel lacks: three channels
// By how much the squared error falls with the logarithm of the opacity: w D . missing,
BINOSPLAT_CONSTANT uint kSumOpacityPull = 4;
// w D . D, where D is how far the splat's colour is from what lies behind it
BINOSPLAT_CONSTANT uint kSumOpacityHold = 5;
BINOSPLAT_CONSTANT uint kSumSizePull = 6;  // and with that of its size: rho times the former,
BINOSPLAT_CONSTANT uint kSumSizeHold = 7;  // and rho^2 times
BINOSPLAT_CONSTANT uint kErrorSums = 2, kContributionSums = 8;
BINOSPLAT_CONSTANT float kSquareScale = 64.0f;  // mean squares up to 1/16 are told apart, in steps of 2^-26

// Depths are counted in bins of 1/32 octave, from 2^-16 to 2^16 scene units.
BINOSPLAT_CONSTANT uint kDepthBins = 1024;
// Tiles that a workgroup of depth_bounds counts: 16 pixels per invocation, each of which clears eight bins
// and adds up eight.
BINOSPLAT_CONSTANT uint kBoundsTiles = 16;

BINOSPLAT_END_SHARED

#endif
