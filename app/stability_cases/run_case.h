// One case of the catalogue: on the device in every mode, twice, and on the float64 twin.
#pragma once

#include "app/stability_cases/catalogue.h"
#include "app/stability_cases/sequences.h"
#include "engine/frame/stereo_frame.h"

#include <optional>
#include <string>
#include <vector>

namespace binosplat::stability {

// A picture beside its twin.
struct PictureScore {
    Mode mode = Mode::kMono;
    std::string eye;       // "middle", "left" or "right"
    bool moved = false;    // reprojected from the other eye
    double psnr_db = 0.0;  // infinite where both are equal
    double share_off = 0.0;
    double largest = 0.0;
    double other_tiles = 0.0;
    std::uint64_t not_finite = 0;  // of the picture's values and of the dominant eye's depths
    bool repeats = false;          // the second run gave the same bytes
    bool passes = false;           // keeps to its bound, is finite and repeats
};

struct CaseScore {
    std::vector<PictureScore> pictures;

    [[nodiscard]] bool passes() const;
    // The picture with the greatest error among a mode's.
    [[nodiscard]] const PictureScore& worstOf(Mode mode) const;
};

inline constexpr Mode kModes[] = {Mode::kMono,      Mode::kTwoPass, Mode::kShared,
                                  Mode::kReproject, Mode::kPaper,   Mode::kPredicted};

// The greatest change of any value from one frame to the next, on the device and in the twin, along a path.
struct PathScore {
    double device = 0.0, twin = 0.0;
    double psnr_db = 0.0;  // of the worst frame
    std::uint64_t not_finite = 0;
    bool passes = false;
};

// Pairs of a sequence beside full renders of the same eyes.
struct SequenceScore {
    struct Frame {
        int frame;
        PictureScore picture;  // of one eye
    };
    std::vector<Frame> frames;
    double psnr_db = 0.0;   // of the worst
    double drift_db = 0.0;  // how much worse the last third of them is than the first third
    // How far any value lies beyond what the full render has in the 7x7 pixels around it.
    double beyond = 0.0;
    double bias = 0.0;  // how far the mean of all values is off, at most
    std::uint64_t not_finite = 0;
    bool repeats = false;  // a second run came to the same bytes, after 60 frames at most
    // From this frame on, all are the full render's bytes; the number of frames if there is none.
    int equal_from = 0;
    bool passes = false;
};

// Runs cases one after the other, in frames that keep what is compiled.
class CaseRunner {
public:
    explicit CaseRunner(const Context& context) : context_(context) {}
    CaseScore run(const Case& one);
    PathScore run(const Path& path);
    SequenceScore run(const Sequence& sequence);

private:
    StereoFrame& show(const Stage& stage);
    StereoFrame& showIn(std::optional<StereoFrame>& frame);
    // Plays this many frames, and calls `after` with the number and the eyes of each.
    void play(const Sequence& sequence, int frames,
              const std::function<void(int, const std::array<Eye, 2>&)>& after);

    const Context& context_;
    std::optional<GpuScene> scene_;  // of the last stage
    std::optional<StereoFrame> frame_;
    std::optional<StereoFrame> full_;  // of the same scene, for full renders beside a sequence's frames
};

}  // namespace binosplat::stability
