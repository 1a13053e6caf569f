// Finds the system's fonts with fontconfig.
#include "app/view/panel/system_fonts.h"

#include "app/view/panel/unique_of.h"

#include <fontconfig/fontconfig.h>

namespace binosplat {

namespace {

using Pattern = UniqueOf<FcPattern, FcPatternDestroy>;
using FontSet = UniqueOf<FcFontSet, FcFontSetDestroy>;
using CharSet = UniqueOf<FcCharSet, FcCharSetDestroy>;
using Config = UniqueOf<FcConfig, FcConfigDestroy>;

bool isTrue(FcPattern* font, const char* property) {
    FcBool value = FcFalse;
    return FcPatternGetBool(font, property, 0, &value) == FcResultMatch && value == FcTrue;
}

// ImGui's font reader knows only plain outlines: no colours and no variable fonts.
bool isReadable(FcPattern* font) {
    return isTrue(font, FC_OUTLINE) && !isTrue(font, FC_COLOR) && !isTrue(font, FC_VARIABLE);
}

}  // namespace

std::vector<SystemFont> fontsWith(const std::set<std::uint32_t>& letters) {
    std::vector<SystemFont> fonts;
    const Config config(FcInitLoadConfigAndFonts());
    const CharSet wanted(FcCharSetCreate());
    const Pattern pattern(FcPatternCreate());
    if (!config || !wanted || !pattern) { return fonts; }
    for (const std::uint32_t letter : letters) { FcCharSetAddChar(wanted.get(), letter); }
    FcPatternAddString(pattern.get(), FC_FAMILY, reinterpret_cast<const FcChar8*>("sans-serif"));
    FcPatternAddCharSet(pattern.get(), FC_CHARSET, wanted.get());
    FcConfigSubstitute(config.get(), pattern.get(), FcMatchPattern);
    FcDefaultSubstitute(pattern.get());
    FcResult result = FcResultMatch;
    const FontSet sorted(FcFontSort(config.get(), pattern.get(), FcFalse, nullptr, &result));
    std::set<std::uint32_t> left = letters;
    for (int i = 0; sorted && i < sorted->nfont && !left.empty(); ++i) {
        FcPattern* const font = sorted->fonts[i];
        FcChar8* file = nullptr;
        FcCharSet* has = nullptr;
        int number = 0;
        if (!isReadable(font) || FcPatternGetString(font, FC_FILE, 0, &file) != FcResultMatch ||
            FcPatternGetCharSet(font, FC_CHARSET, 0, &has) != FcResultMatch) {
            continue;
        }
        static_cast<void>(FcPatternGetInteger(font, FC_INDEX, 0, &number));
        if (std::erase_if(
                left, [&](std::uint32_t letter) { return FcCharSetHasChar(has, letter) == FcTrue; }) == 0) {
            continue;
        }
        fonts.push_back({reinterpret_cast<const char*>(file), number & 0xffff});
    }
    return fonts;
}

}  // namespace binosplat
