// A table as text.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace binosplat {

// Right-aligned columns as wide as their widest cell; the first is left-aligned.
class TextColumns {
public:
    void addRow(std::vector<std::string> cells) {
        widths_.resize(std::max(widths_.size(), cells.size()), 0);
        for (std::size_t i = 0; i < cells.size(); ++i) { widths_[i] = std::max(widths_[i], cells[i].size()); }
        rows_.push_back(std::move(cells));
    }
    // A table wider than `most` characters is several, one below the other, each with the first column.
    [[nodiscard]] std::string text(std::size_t most = SIZE_MAX) const {
        std::string text;
        for (std::size_t begin = 1, end = 1; begin == 1 || begin < widths_.size(); begin = end) {
            std::size_t width = kGap + widths_[0];
            for (; end < widths_.size() && (end == begin || width + kGap + widths_[end] <= most); ++end) {
                width += kGap + widths_[end];
            }
            end = std::max(end, begin + 1);
            for (const std::vector<std::string>& row : rows_) {
                if (begin > 1 && begin >= row.size()) { continue; }
                text += fmt::format("  {:<{}}", row[0], widths_[0]);
                for (std::size_t i = begin; i < std::min(end, row.size()); ++i) {
                    text += fmt::format("  {:>{}}", row[i], widths_[i]);
                }
                text += "\n";
            }
        }
        return text;
    }

private:
    static constexpr std::size_t kGap = 2;

    std::vector<std::vector<std::string>> rows_;
    std::vector<std::size_t> widths_;
};

}  // namespace binosplat
