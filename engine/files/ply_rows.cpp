// Conversion loops: one per type and byte order for binary rows, one for ascii.
#include "engine/files/ply_rows.h"

#include "engine/error.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

namespace binosplat::ply {

namespace {

template <typename T, bool kSwap>
T loadValue(const std::byte* source) {
    std::array<std::byte, sizeof(T)> bytes;
    std::memcpy(bytes.data(), source, sizeof(T));
    if constexpr (kSwap) { std::reverse(bytes.begin(), bytes.end()); }
    return std::bit_cast<T>(bytes);
}

// One property of a block: rows are `stride` bytes apart, and values in the block `step` apart. `zero` is
// subtracted from a float64.
template <typename T, bool kSwap>
void convertColumn(const std::byte* source, std::size_t stride, std::size_t rows, float* target,
                   std::size_t step, double zero) {
    for (std::size_t row = 0; row < rows; ++row) {
        const T value = loadValue<T, kSwap>(source + row * stride);
        if constexpr (std::is_same_v<T, double>) {
            target[row * step] = static_cast<float>(value - zero);
        } else {
            target[row * step] = static_cast<float>(value);
        }
    }
}

using ConvertColumn = void (*)(const std::byte*, std::size_t, std::size_t, float*, std::size_t, double);

template <bool kSwap>
ConvertColumn selectConversion(Type type) {
    switch (type) {
        case Type::kInt8:
            return convertColumn<std::int8_t, kSwap>;
        case Type::kUint8:
            return convertColumn<std::uint8_t, kSwap>;
        case Type::kInt16:
            return convertColumn<std::int16_t, kSwap>;
        case Type::kUint16:
            return convertColumn<std::uint16_t, kSwap>;
        case Type::kInt32:
            return convertColumn<std::int32_t, kSwap>;
        case Type::kUint32:
            return convertColumn<std::uint32_t, kSwap>;
        case Type::kFloat32:
            return convertColumn<float, kSwap>;
        case Type::kFloat64:
            return convertColumn<double, kSwap>;
    }
    return nullptr;
}

bool needsSwap(Encoding encoding) {
    return (encoding == Encoding::kLittleEndian) != (std::endian::native == std::endian::little);
}

class BinaryRows final : public RowReader {
public:
    BinaryRows(InputFile& file, Encoding encoding, const Element& element, const std::vector<Column>& columns)
        : file_(file), total_(element.count), stride_(element.rowBytes()) {
        std::vector<std::size_t> offsets(element.properties.size());
        for (std::size_t i = 1; i < offsets.size(); ++i) {
            offsets[i] = offsets[i - 1] + typeBytes(element.properties[i - 1].type);
        }
        for (const Column& column : columns) {
            const Type type = element.properties[column.property].type;
            columns_.push_back(
                {offsets[column.property],
                 needsSwap(encoding) ? selectConversion<true>(type) : selectConversion<false>(type),
                 column.attribute});
            if (column.attribute < kStoredRest0) { continue; }
            const auto i = static_cast<std::size_t>(column.attribute - kStoredRest0);
            const bool in_place = type == Type::kFloat32 && !needsSwap(encoding) && i == rest_count_ &&
                                  (i == 0 || offsets[column.property] == rest_offset_ + 4 * i);
            if (i == 0) { rest_offset_ = offsets[column.property]; }
            rest_count_ += in_place;
        }
        // Values that are laid out in the file as in a block are copied together.
        std::erase_if(columns_, [&](const Source& source) {
            return source.attribute >= kStoredRest0 &&
                   static_cast<std::size_t>(source.attribute - kStoredRest0) < rest_count_;
        });
    }

    void read(StoredBlock& block) override {
        // A row is at most 480 KB (the header's limit), so at least one fits into the file's buffer.
        const std::size_t rows_at_once = std::max<std::size_t>(1, std::min(block.rows, kReadBytes / stride_));
        for (std::size_t done = 0; done < block.rows;) {
            const std::size_t rows = std::min(rows_at_once, block.rows - done);
            const std::span<const std::byte> bytes = file_.readBlock(rows * stride_);
            check(bytes.size() == rows * stride_, "{}: data: ends in splat {} of {}", file_.name(),
                  done_ + bytes.size() / stride_, total_);
            convert(bytes.data(), rows, block, done);
            done += rows;
            done_ += rows;
        }
    }

    void sample(StoredBlock& block) const override {
        block.rows = static_cast<std::size_t>(std::min<std::uint64_t>(StoredBlock::kRows, total_));
        std::vector<std::byte> row(stride_);
        for (std::size_t i = 0; i < block.rows; ++i) {
            const std::uint64_t offset = file_.positionBytes() + total_ * i / block.rows * stride_;
            // It has been cut off, which reading it will report.
            if (file_.readAt(offset, row) < row.size()) {
                block.rows = i;
                return;
            }
            convert(row.data(), 1, block, i);
        }
    }

    void countFrom(const glm::dvec3& origin) override {
        for (Source& source : columns_) {
            if (source.attribute <= kStoredZ) { source.zero = origin[source.attribute]; }
        }
    }

private:
    // From `source` on to the rows of `block` from `first` on.
    void convert(const std::byte* source, std::size_t rows, StoredBlock& block, std::size_t first) const {
        for (const Source& one : columns_) {
            const bool is_rest = one.attribute >= kStoredRest0;
            float* target = is_rest ? block.rest(first) + (one.attribute - kStoredRest0)
                                    : block.column(one.attribute) + first;
            one.convert(source + one.offset, stride_, rows, target, is_rest ? StoredBlock::kRestStride : 1,
                        one.zero);
        }
        for (std::size_t row = 0; rest_count_ > 0 && row < rows; ++row) {
            std::memcpy(block.rest(first + row), source + row * stride_ + rest_offset_,
                        rest_count_ * sizeof(float));
        }
    }

    static constexpr std::size_t kReadBytes = std::size_t{1} << 19;
    struct Source {
        std::size_t offset;
        ConvertColumn convert;
        int attribute;
        double zero = 0.0;
    };
    InputFile& file_;
    std::uint64_t total_, done_ = 0;
    std::size_t stride_;
    // The first f_rest values, if they lie together as float32.
    std::size_t rest_offset_ = 0, rest_count_ = 0;
    std::vector<Source> columns_;
};

// The number at the front of `text`, which is advanced past it; false if there is none. Overflow gives an
// infinity.
bool takeNumber(std::string_view& text, double& value) {
    const std::size_t start = text.find_first_not_of(" \t");
    if (start == std::string_view::npos) { return false; }
    text.remove_prefix(start);
    const std::size_t length = std::min(text.find_first_of(" \t"), text.size());
    const char* begin = text.data() + (text[0] == '+' && length > 1 ? 1 : 0);
    const auto [end, error] = std::from_chars(begin, text.data() + length, value);
    if (error == std::errc::invalid_argument || end != text.data() + length) { return false; }
    // Beyond float64's range, from_chars leaves the value unset; all that matters is whether the exponent was
    // negative.
    if (error == std::errc::result_out_of_range) {
        const bool tiny = text.substr(0, length).find("e-") != std::string_view::npos ||
                          text.substr(0, length).find("E-") != std::string_view::npos;
        value = tiny ? 0.0 : std::numeric_limits<double>::infinity();
    }
    text.remove_prefix(length);
    return true;
}

class AsciiRows final : public RowReader {
public:
    AsciiRows(InputFile& file, const Element& element, const std::vector<Column>& columns)
        : file_(file), element_(element), attribute_of_(element.properties.size(), -1) {
        for (const Column& column : columns) { attribute_of_[column.property] = column.attribute; }
    }

    void read(StoredBlock& block) override {
        for (std::size_t row = 0; row < block.rows; ++row, ++done_) {
            std::string_view text;
            InputFile::LineEnd end{};
            do {
                end = file_.readLine(text);
            } while (end == InputFile::LineEnd::kBreak &&
                     text.find_first_not_of(" \t") == std::string_view::npos);
            check(end != InputFile::LineEnd::kNoLine, "{}: data: ends before splat {} of {}", file_.name(),
                  done_, element_.count);
            // A number that is cut short is still a number; only the line break shows that the last one is
            // whole.
            check(end == InputFile::LineEnd::kBreak,
                  "{}: data: ends in splat {} of {}: its line has no line break", file_.name(), done_,
                  element_.count);
            for (std::size_t i = 0; i < attribute_of_.size(); ++i) {
                double value = 0.0;
                const std::string_view rest = text;
                check(takeNumber(text, value), "{}: splat {} of {}: property {} is '{}', expected a number",
                      file_.name(), done_, element_.count, element_.properties[i].name, firstWord(rest));
                put(block, attribute_of_[i], row, value);
            }
            check(text.find_first_not_of(" \t") == std::string_view::npos,
                  "{}: splat {} of {}: more than the expected {} values in its line", file_.name(), done_,
                  element_.count, attribute_of_.size());
        }
    }

    void sample(StoredBlock& block) const override {
        std::string_view ahead = file_.peek(kSampleBytes);
        const auto most =
            static_cast<std::size_t>(std::min<std::uint64_t>(StoredBlock::kRows, element_.count));
        block.rows = 0;
        for (std::size_t end = 0; block.rows < most && (end = ahead.find('\n')) != std::string_view::npos;
             ahead.remove_prefix(end + 1)) {
            std::string_view text =
                ahead.substr(0, ahead[std::max<std::size_t>(end, 1) - 1] == '\r' ? end - 1 : end);
            if (text.find_first_not_of(" \t") == std::string_view::npos) { continue; }
            for (const int attribute : attribute_of_) {
                double value = 0.0;
                if (!takeNumber(text, value)) { return; }  // which reading it will report
                put(block, attribute, block.rows, value);
            }
            ++block.rows;
        }
    }

    void countFrom(const glm::dvec3& origin) override { origin_ = origin; }

private:
    void put(StoredBlock& block, int attribute, std::size_t row, double value) const {
        if (attribute < 0) { return; }
        block.put(attribute, row,
                  static_cast<float>(attribute <= kStoredZ ? value - origin_[attribute] : value));
    }

    static constexpr std::size_t kSampleBytes = std::size_t{1} << 18;

    static std::string firstWord(std::string_view text) {
        const std::size_t start = std::min(text.find_first_not_of(" \t"), text.size());
        const std::size_t end = std::min(text.find_first_of(" \t", start), text.size());
        std::string word(text.substr(start, std::min<std::size_t>(end - start, 40)));
        for (char& letter : word) {
            if (letter < ' ' || letter > '~') { letter = '?'; }
        }
        return word;
    }

    InputFile& file_;
    const Element& element_;
    std::uint64_t done_ = 0;
    std::vector<int> attribute_of_;  // -1: not wanted
    glm::dvec3 origin_{0.0};
};

// The count at the start of a binary list.
std::uint64_t readListCount(InputFile& file, Encoding encoding, const Element& element,
                            const Property& property) {
    const std::span<const std::byte> bytes = file.readBlock(typeBytes(property.count_type));
    check(bytes.size() == typeBytes(property.count_type), "{}: data: ends in element {}, list {}",
          file.name(), element.name, property.name);
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        const std::size_t at = encoding == Encoding::kBigEndian ? i : bytes.size() - 1 - i;
        count = count << 8 | std::to_integer<std::uint64_t>(bytes[at]);
    }
    return count;
}

}  // namespace

void skipElement(InputFile& file, Encoding encoding, const Element& element) {
    if (element.properties.empty()) { return; }
    if (encoding == Encoding::kAscii) {
        std::string_view text;
        for (std::uint64_t row = 0; row < element.count;) {
            check(file.readLine(text) == InputFile::LineEnd::kBreak,
                  "{}: data: ends in row {} of {} of element {}", file.name(), row, element.count,
                  element.name);
            row += text.find_first_not_of(" \t") != std::string_view::npos;
        }
        return;
    }
    if (!element.hasList()) {
        check(element.count <= file.bytesLeft() / element.rowBytes(),
              "{}: data: {} rows of element {} take {} bytes each, but only {} bytes are left", file.name(),
              element.count, element.name, element.rowBytes(), file.bytesLeft());
        file.skip(element.count * element.rowBytes());
        return;
    }
    for (std::uint64_t row = 0; row < element.count; ++row) {
        for (const Property& property : element.properties) {
            const std::uint64_t items =
                property.is_list ? readListCount(file, encoding, element, property) : 1;
            check(items <= file.bytesLeft() / typeBytes(property.type),
                  "{}: data: ends in row {} of {} of element {}", file.name(), row, element.count,
                  element.name);
            file.skip(items * typeBytes(property.type));
        }
    }
}

std::unique_ptr<RowReader> openRows(InputFile& file, const Header& header, const Element& element,
                                    std::vector<Column> columns) {
    const std::uint64_t left = file.bytesLeft();
    if (header.encoding == Encoding::kAscii) {
        // The shortest row has one digit and one separator per property.
        const std::uint64_t shortest = 2 * element.properties.size();
        check(element.count <= left / shortest,
              "{}: data: ends before splat {} of {}: {} bytes are left, at least {} per splat expected",
              file.name(), left / shortest, element.count, left, shortest);
        return std::make_unique<AsciiRows>(file, element, columns);
    }
    const std::uint64_t stride = element.rowBytes();
    check(element.count <= left / stride,
          "{}: data: ends in splat {} of {}: {} bytes are left, {} per splat expected", file.name(),
          left / stride, element.count, left, stride);
    return std::make_unique<BinaryRows>(file, header.encoding, element, columns);
}

}  // namespace binosplat::ply
