// A table as text.
#pragma once

#include <fmt/format.h>

#include <algorithm>
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
    [[nodiscard]] std::string text() const {
        std::string text;
        for (const std::vector<std::string>& row : rows_) {
            text += fmt::format("  {:<{}}", row[0], widths_[0]);
            for (std::size_t i = 1; i < row.size(); ++i) { text += fmt::format("  {:>{}}", row[i], widths_[i]); }
            text += "\n";
        }
        return text;
    }

private:
    std::vector<std::vector<std::string>> rows_;
    std::vector<std::size_t> widths_;
};

}  // namespace binosplat
