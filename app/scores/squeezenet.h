// SqueezeNet 1.1 without its classifier: features of a picture from a network trained on photographs.
// Iandola, Han, Moskewicz, Ashraf, Dally, Keutzer, "SqueezeNet: AlexNet-level accuracy with 50x fewer
// parameters and <0.5MB model size", arXiv:1602.07360, 2016, section 3; 1.1 is its authors' cheaper variant,
// which convolves 3x3 first and pools earlier.
#pragma once

#include "engine/picture/image.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace binosplat {

// A convolution and the ReLU after it.
struct Convolution {
    std::size_t inputs = 0, outputs = 0;  // channels; outputs are a multiple of 8
    std::size_t side = 1, stride = 1;     // of the kernel, in pixels
    std::vector<float> weights;           // as the loops read them, see squeezenet.cpp
    std::vector<float> biases;
};

// Squeezes to few channels, then expands these by 1x1 and by 3x3; the output is both expansions, one behind
// the other.
struct FireModule {
    Convolution squeeze, expand_1x1, expand_3x3;
};

// The network in seven stages; each gives a feature map: an Image of more channels and fewer pixels.
//
//   stage 0: convolution 3x3, stride 2, no padding      stage 3: 3x3 max pooling, Fire 5
//   stage 1: 3x3 max pooling, Fire 1, Fire 2            stage 4: Fire 6
//   stage 2: 3x3 max pooling, Fire 3, Fire 4            stages 5, 6: Fire 7, Fire 8
//
// Pooling has stride 2 and takes the part of a window that is inside at the far edges: of n pixels it leaves
// n/2, rounded down.
class SqueezeNet {
public:
    static constexpr std::array<std::size_t, 7> kStageChannels{64, 128, 256, 384, 384, 512, 512};
    static constexpr std::size_t kWeights = 722'496;
    // Smaller pictures leave nothing after the last pooling: 17 pixels become 8 by the convolution, then 4, 2
    // and 1.
    static constexpr std::uint32_t kLeastSide_px = 17;

    // kWeights values: the 25 convolutions in order, those of a Fire module as FireModule lists them; of each
    // its weights (output x input x row x column), then its biases.
    explicit SqueezeNet(std::span<const float> values);

    // The output of `stage` for the previous stage's output; stage 0 takes three channels, scaled as in
    // training. The result does not depend on the number of threads.
    [[nodiscard]] Image runStage(std::size_t stage, Image before, int threads) const;

private:
    Convolution first_;
    std::array<FireModule, 8> fires_;
};

}  // namespace binosplat
