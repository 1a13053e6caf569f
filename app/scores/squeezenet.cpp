// SqueezeNet's layers on the CPU. Channels lie side by side, so that a row of a kernel covers one run of
// neighbouring values.
#include "app/scores/squeezenet.h"

#include "engine/parallel.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <utility>

namespace binosplat {

namespace {

struct FireShape {
    std::size_t inputs, squeezed, expanded;  // channels; as many from either expansion
};
constexpr std::array<FireShape, 8> kFires{{{64, 16, 64},
                                           {128, 16, 64},
                                           {128, 32, 128},
                                           {256, 32, 128},
                                           {256, 48, 192},
                                           {384, 48, 192},
                                           {384, 64, 256},
                                           {512, 64, 256}}};
// A stage's Fire modules: from its own entry to the next one's.
constexpr std::array<std::size_t, 8> kFirstFire{0, 0, 2, 4, 5, 6, 7, 8};
constexpr bool poolsBefore(std::size_t stage) { return stage >= 1 && stage <= 3; }

constexpr std::size_t countOf(std::size_t inputs, std::size_t outputs, std::size_t side) {
    return (inputs * side * side + 1) * outputs;
}
constexpr std::size_t countAll() {
    std::size_t count = countOf(3, 64, 3);
    for (const FireShape& fire : kFires) {
        count += countOf(fire.inputs, fire.squeezed, 1) + countOf(fire.squeezed, fire.expanded, 1) +
                 countOf(fire.squeezed, fire.expanded, 3);
    }
    return count;
}
static_assert(countAll() == SqueezeNet::kWeights);

// Sums that are kept in registers at a time: 4 pixels by 8 channels are 8 of the 16 that any x86-64 has.
constexpr std::size_t kPixels = 4, kChannels = 8;
// A register's four floats, as GCC and clang spell it. Of plain loops GCC 12 vectorizes the wrong one, which
// takes three times as long.
using Four = float __attribute__((vector_size(16)));
Four loadFour(const float* from) {
    Four values;
    std::memcpy(&values, from, sizeof(values));
    return values;
}

constexpr std::size_t kRowsAtATime = 4;  // of a thread

// Takes a convolution's values off the front. Where the file has output x input x row x column, the loops
// read block of outputs x row x column x input x output of the block.
Convolution takeConvolution(std::span<const float>& values, std::size_t inputs, std::size_t outputs,
                            std::size_t side, std::size_t stride) {
    Convolution convolution{inputs, outputs, side, stride, {}, {}};
    for (std::size_t block = 0; block < outputs; block += kChannels) {
        for (std::size_t tap = 0; tap < side * side; ++tap) {
            for (std::size_t input = 0; input < inputs; ++input) {
                for (std::size_t output = block; output < block + kChannels; ++output) {
                    convolution.weights.push_back(values[(output * inputs + input) * side * side + tap]);
                }
            }
        }
    }
    const std::span<const float> biases = values.subspan(convolution.weights.size(), outputs);
    convolution.biases.assign(biases.begin(), biases.end());
    values = values.subspan(convolution.weights.size() + outputs);
    return convolution;
}

Image makeMap(glm::uvec2 size_px, std::size_t channels) {
    return {size_px, static_cast<int>(channels),
            std::vector<float>(std::size_t{size_px.x} * size_px.y * channels, 0.0f)};
}

const float* pixelAt(const Image& map, std::size_t x, std::size_t y) {
    return map.values.data() + (y * map.size_px.x + x) * static_cast<std::size_t>(map.channels);
}
float* pixelAt(Image& map, std::size_t x, std::size_t y) {
    return map.values.data() + (y * map.size_px.x + x) * static_cast<std::size_t>(map.channels);
}

// A block of output channels of `count` neighbouring pixels, from x on. `out` is the first one's block in a
// map of `out_step` channels.
template <std::size_t count>
void convolvePixels(const Image& in, const Convolution& convolution, std::size_t block, std::size_t x,
                    std::size_t y, float* out, std::size_t out_step) {
    const std::size_t run = convolution.side * convolution.inputs,
                      step = convolution.stride * convolution.inputs;
    const float* weights = convolution.weights.data() + block * convolution.side * run;
    const Four low = loadFour(&convolution.biases[block]), high = loadFour(&convolution.biases[block + 4]);
    Four sums[count][2];
    for (auto& sum : sums) {
        sum[0] = low;
        sum[1] = high;
    }
    for (std::size_t row = 0; row < convolution.side; ++row) {
        const float* from = pixelAt(in, x * convolution.stride, y * convolution.stride + row);
        for (std::size_t value = 0; value < run; ++value, weights += kChannels) {
            const Four weights_low = loadFour(weights), weights_high = loadFour(weights + 4);
            for (std::size_t pixel = 0; pixel < count; ++pixel) {
                sums[pixel][0] += from[pixel * step + value] * weights_low;
                sums[pixel][1] += from[pixel * step + value] * weights_high;
            }
        }
    }
    for (std::size_t pixel = 0; pixel < count; ++pixel) {
        for (std::size_t i = 0; i < kChannels; ++i) {
            out[pixel * out_step + i] = std::max(sums[pixel][i / 4][i % 4], 0.0f);
        }
    }
}

// Every place where the kernel lies wholly inside `in`. Writes the channels of `out` from `first_channel` on.
void convolve(const Image& in, const Convolution& convolution, Image& out, std::size_t first_channel,
              int threads) {
    assert(static_cast<std::size_t>(in.channels) == convolution.inputs);
    const std::size_t width = out.size_px.x, out_step = static_cast<std::size_t>(out.channels);
    forBlocks(out.size_px.y, kRowsAtATime, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t y = begin; y < end; ++y) {
            // A block's weights stay in the cache for the whole row.
            for (std::size_t block = 0; block < convolution.outputs; block += kChannels) {
                float* row = pixelAt(out, 0, y) + first_channel + block;
                std::size_t x = 0;
                for (; x + kPixels <= width; x += kPixels) {
                    convolvePixels<kPixels>(in, convolution, block, x, y, row + x * out_step, out_step);
                }
                for (; x < width; ++x) {
                    convolvePixels<1>(in, convolution, block, x, y, row + x * out_step, out_step);
                }
            }
        }
    });
}

Image poolMaxima(const Image& in, int threads) {
    Image out = makeMap(in.size_px / 2u, static_cast<std::size_t>(in.channels));
    forBlocks(out.size_px.y, kRowsAtATime, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t y = begin; y < end; ++y) {
            for (std::size_t x = 0; x < out.size_px.x; ++x) {
                float* most = pixelAt(out, x, y);  // zeros, and behind a ReLU nothing is less
                for (std::size_t from_y = 2 * y; from_y < std::min<std::size_t>(2 * y + 3, in.size_px.y);
                     ++from_y) {
                    for (std::size_t from_x = 2 * x; from_x < std::min<std::size_t>(2 * x + 3, in.size_px.x);
                         ++from_x) {
                        const float* from = pixelAt(in, from_x, from_y);
                        for (int i = 0; i < in.channels; ++i) { most[i] = std::max(most[i], from[i]); }
                    }
                }
            }
        }
    });
    return out;
}

// One pixel of zeros all around.
Image padBorder(const Image& in) {
    const auto channels = static_cast<std::size_t>(in.channels);
    Image out = makeMap(in.size_px + 2u, channels);
    for (std::size_t y = 0; y < in.size_px.y; ++y) {
        std::copy_n(pixelAt(in, 0, y), in.size_px.x * channels, pixelAt(out, 1, y + 1));
    }
    return out;
}

Image runFire(const Image& in, const FireModule& fire, int threads) {
    Image squeezed = makeMap(in.size_px, fire.squeeze.outputs);
    convolve(in, fire.squeeze, squeezed, 0, threads);
    Image out = makeMap(in.size_px, fire.expand_1x1.outputs + fire.expand_3x3.outputs);
    convolve(squeezed, fire.expand_1x1, out, 0, threads);
    convolve(padBorder(squeezed), fire.expand_3x3, out, fire.expand_1x1.outputs, threads);
    return out;
}

}  // namespace

SqueezeNet::SqueezeNet(std::span<const float> values) {
    assert(values.size() == kWeights);
    first_ = takeConvolution(values, 3, 64, 3, 2);
    for (std::size_t i = 0; i < kFires.size(); ++i) {
        const auto& [inputs, squeezed, expanded] = kFires[i];
        fires_[i].squeeze = takeConvolution(values, inputs, squeezed, 1, 1);
        fires_[i].expand_1x1 = takeConvolution(values, squeezed, expanded, 1, 1);
        fires_[i].expand_3x3 = takeConvolution(values, squeezed, expanded, 3, 1);
    }
}

Image SqueezeNet::runStage(std::size_t stage, Image before, int threads) const {
    assert(stage < kStageChannels.size());
    if (stage == 0) {
        assert(before.size_px.x >= kLeastSide_px && before.size_px.y >= kLeastSide_px);
        Image out = makeMap((before.size_px - 1u) / 2u, first_.outputs);
        convolve(before, first_, out, 0, threads);
        return out;
    }
    if (poolsBefore(stage)) { before = poolMaxima(before, threads); }
    for (std::size_t fire = kFirstFire[stage]; fire < kFirstFire[stage + 1]; ++fire) {
        before = runFire(before, fires_[fire], threads);
    }
    return before;
}

}  // namespace binosplat
