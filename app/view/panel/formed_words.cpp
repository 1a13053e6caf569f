// HarfBuzz chooses and places the glyphs, FreeType draws them.
#include "app/view/panel/formed_words.h"

#include "app/view/panel/unique_of.h"

#include <ft2build.h>
#include FT_FREETYPE_H
#include <hb.h>

#include <array>
#include <cmath>

namespace binosplat {

namespace {

constexpr float kUnits = 64.0f;  // per pixel, in both libraries
constexpr unsigned kDotsPerInch = 72;

// A glyph of a font, and its x, y and advance in units.
using PlacedGlyph = std::array<std::int64_t, 4>;

class FormingFont {
public:
    FormingFont(FT_Library library, const LoadedFont& loaded) {
        FT_Face face = nullptr;
        const auto* const bytes = reinterpret_cast<const FT_Byte*>(loaded.bytes.data());
        if (FT_New_Memory_Face(library, bytes, static_cast<FT_Long>(loaded.bytes.size()), loaded.font.number,
                               &face) != 0) {
            return;
        }
        face_.reset(face);
        const UniqueOf<hb_blob_t, hb_blob_destroy> blob(
            hb_blob_create(loaded.bytes.data(), static_cast<unsigned>(loaded.bytes.size()),
                           HB_MEMORY_MODE_READONLY, nullptr, nullptr));
        const UniqueOf<hb_face_t, hb_face_destroy> tables(
            hb_face_create(blob.get(), static_cast<unsigned>(loaded.font.number)));
        font_.reset(hb_font_create(tables.get()));
    }

    // In units, for lines that reach from the font's ascent to its descent, as in ImGui; 0: not a font.
    [[nodiscard]] int em(float line_px) const {
        const int line_units = face_ ? face_->ascender - face_->descender : 0;
        return line_units <= 0
                   ? 0
                   : static_cast<int>(std::lround(kUnits * line_px * static_cast<float>(face_->units_per_EM) /
                                                  static_cast<float>(line_units)));
    }
    void setEm(int em) {
        if (!font_ || FT_Set_Char_Size(face_.get(), 0, em, 2 * kDotsPerInch, kDotsPerInch) != 0) {
            font_.reset();
        }
        if (font_) { hb_font_set_scale(font_.get(), em, em); }
    }

    // From left to right; empty if the font lacks a glyph.
    [[nodiscard]] std::vector<PlacedGlyph> form(const std::u32string& word) const {
        if (!font_) { return {}; }
        const UniqueOf<hb_buffer_t, hb_buffer_destroy> buffer(hb_buffer_create());
        hb_buffer_add_utf32(buffer.get(), reinterpret_cast<const std::uint32_t*>(word.data()),
                            static_cast<int>(word.size()), 0, -1);
        hb_buffer_guess_segment_properties(buffer.get());
        hb_shape(font_.get(), buffer.get(), nullptr, 0);
        unsigned count = 0;
        const hb_glyph_info_t* const infos = hb_buffer_get_glyph_infos(buffer.get(), &count);
        const hb_glyph_position_t* const places = hb_buffer_get_glyph_positions(buffer.get(), &count);
        std::vector<PlacedGlyph> signs;
        for (unsigned i = 0; i < count; ++i) {
            if (infos[i].codepoint == 0) { return {}; }
            signs.push_back(
                {infos[i].codepoint, places[i].x_offset, places[i].y_offset, places[i].x_advance});
        }
        return signs;
    }

    [[nodiscard]] FormedGlyph draw(const PlacedGlyph& sign) const {
        const auto [glyph, x, y, advance] = sign;
        FormedGlyph drawn{{0, 0}, {}, {0.0f, 0.0f}, static_cast<float>(advance) / kUnits};
        if (FT_Load_Glyph(face_.get(), static_cast<FT_UInt>(glyph), FT_LOAD_NO_HINTING | FT_LOAD_NO_BITMAP) !=
                0 ||
            FT_Render_Glyph(face_->glyph, FT_RENDER_MODE_NORMAL) != 0) {
            return drawn;
        }
        const FT_Bitmap& bitmap = face_->glyph->bitmap;
        drawn.size_px = {bitmap.width, bitmap.rows};
        for (unsigned row = 0; row < bitmap.rows; ++row) {
            const unsigned char* const first =
                bitmap.buffer + static_cast<std::ptrdiff_t>(row) * bitmap.pitch;
            drawn.coverage.insert(drawn.coverage.end(), first, first + bitmap.width);
        }
        drawn.low_px = {static_cast<float>(x) / kUnits + 0.5f * static_cast<float>(face_->glyph->bitmap_left),
                        -static_cast<float>(y) / kUnits - static_cast<float>(face_->glyph->bitmap_top)};
        return drawn;
    }

private:
    UniqueOf<FT_FaceRec_, FT_Done_Face> face_;
    UniqueOf<hb_font_t, hb_font_destroy> font_;
};

}  // namespace

FormedWords formWords(const std::set<std::u32string>& words, std::span<const LoadedFont> fonts, float line_px,
                      std::size_t most_glyphs) {
    FormedWords formed;
    FT_Library begun = nullptr;
    if (words.empty() || FT_Init_FreeType(&begun) != 0) { return formed; }
    const UniqueOf<FT_LibraryRec_, FT_Done_FreeType> library(begun);
    std::vector<FormingFont> forming;
    for (const LoadedFont& font : fonts) { forming.emplace_back(library.get(), font); }
    // Fonts with tall letters have tall lines, which would make all their letters small: all fonts get the
    // first one's em.
    const int em = forming.empty() ? 0 : forming.front().em(line_px);
    if (em == 0) { return formed; }
    for (FormingFont& font : forming) { font.setEm(em); }
    std::map<std::pair<const FormingFont*, PlacedGlyph>, std::size_t> numbers;
    for (const std::u32string& word : words) {
        for (const FormingFont& font : forming) {
            const std::vector<PlacedGlyph> signs = font.form(word);
            if (signs.empty() || formed.signs.size() + signs.size() > most_glyphs) { continue; }
            for (const PlacedGlyph& sign : signs) {
                const auto [number, is_new] = numbers.try_emplace({&font, sign}, formed.signs.size());
                if (is_new) { formed.signs.push_back(font.draw(sign)); }
                formed.words[word].push_back(number->second);
            }
            break;
        }
    }
    return formed;
}

}  // namespace binosplat
