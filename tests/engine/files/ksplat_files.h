// .ksplat files made to measure.
#pragma once

#include "tests/engine/files/ply_files.h"

#include <glm/gtc/packing.hpp>

namespace binosplat::test {

// Sections of five splats each, in buckets of two: two full buckets and one that is not full.
struct KsplatText {
    int level = 1;
    std::vector<int> degrees{1};  // degree of the harmonics, by section
    float least_harmonic = -2.0f, most_harmonic = 2.0f;

    static constexpr int kSplats = 5;
    // Of splat i in a section, on the grid of level 1, whose steps are 1/32767 of 5.
    static double coordinate(int section, int i, int axis) {
        return bucketCentre(section, i / 2, axis) + 5.0 * (1000.0 * i - 2000.0 * axis) / 32767.0;
    }
    static double bucketCentre(int section, int bucket, int axis) {
        return 10.0 * section + 4.0 * bucket - 8.0 * axis;
    }
    static double scale(int i, int axis) { return 0.25 * (i + 1) * (axis + 1); }
    static double harmonic(int i, int k, int channel) { return (i + 1) * 0.25 - 0.125 * k + 0.5 * channel; }

    [[nodiscard]] std::string bytes() const {
        std::string header(4096, '\0'), headers, data;
        const auto set = [](std::string& text, std::size_t at, const char* type, double value) {
            std::string raw;
            appendLittle(raw, type, {value});
            text.replace(at, raw.size(), raw);
        };
        const auto sections = static_cast<double>(degrees.size());
        header[1] = 1;
        set(header, 4, "uint", sections), set(header, 8, "uint", sections);
        set(header, 12, "uint", kSplats * sections), set(header, 16, "uint", kSplats * sections);
        set(header, 20, "ushort", level);
        set(header, 36, "float", least_harmonic), set(header, 40, "float", most_harmonic);
        for (std::size_t section = 0; section < degrees.size(); ++section) {
            std::string own(1024, '\0');
            set(own, 0, "uint", kSplats), set(own, 4, "uint", kSplats), set(own, 8, "uint", 2),
                set(own, 12, "uint", 3);
            set(own, 16, "float", 10.0), set(own, 20, "ushort", 12), set(own, 24, "uint", 32767);
            set(own, 32, "uint", 2), set(own, 36, "uint", 1), set(own, 40, "ushort", degrees[section]);
            headers += own;
            data += sectionData(static_cast<int>(section));
        }
        return header + headers + data;
    }

private:
    [[nodiscard]] std::string sectionData(int section) const {
        std::string data;
        appendLittle(data, "uint", {1});  // splats in the last bucket
        for (int bucket = 0; bucket < 3; ++bucket) {
            for (int axis = 0; axis < 3; ++axis) {
                appendLittle(data, "float", {bucketCentre(section, bucket, axis)});
            }
        }
        const auto number = [&](double value) {
            if (level == 0) { return appendLittle(data, "float", {value}); }
            appendLittle(data, "ushort", {static_cast<double>(glm::packHalf1x16(static_cast<float>(value)))});
        };
        for (int i = 0; i < kSplats; ++i) {
            for (int axis = 0; axis < 3; ++axis) {
                const double place = coordinate(section, i, axis);
                const double steps = (place - bucketCentre(section, i / 2, axis)) * 32767.0 / 5.0;
                level == 0 ? number(place) : appendLittle(data, "ushort", {std::round(steps) + 32767.0});
            }
            for (int axis = 0; axis < 3; ++axis) { number(scale(i, axis)); }
            for (const double part : {0.5, -0.5, 0.5, i == 0 ? -0.5 : 0.5}) { number(part); }
            for (const int byte : {51 * i, 255 - 51 * i, 102, 255 - 51 * i}) {
                data += static_cast<char>(byte);
            }
            for (int band = 1; band <= degrees[section]; ++band) {
                for (int channel = 0; channel < 3; ++channel) {
                    for (int k = band * band; k < (band + 1) * (band + 1); ++k) {
                        const double value = harmonic(i, k, channel);
                        if (level < 2) {
                            number(value);
                        } else {
                            const double share = (value - least_harmonic) / (most_harmonic - least_harmonic);
                            data += static_cast<char>(std::lround(255.0 * std::clamp(share, 0.0, 1.0)));
                        }
                    }
                }
            }
        }
        return data;
    }
};

}  // namespace binosplat::test
