// Facts about the panel's letters: the panel can show names in any script.
#include "tests/app/view/panel/panel_sketch.h"
#include "tests/run_program.h"

SUITE(letters) {

// Where the vector font is, if this machine has one.
std::string vectorFont() {
    for (const fs::path& file : fontFiles()) {
        if (fs::exists(file)) { return textIn(file); }
    }
    return {};
}

bool isFont(const std::string& bytes) {
    return looksLikeFont({reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()});
}

// A letter of three bytes in UTF-8.
std::string utf8(unsigned letter) {
    return {static_cast<char>(0xe0 | letter >> 12), static_cast<char>(0x80 | (letter >> 6 & 0x3f)),
            static_cast<char>(0x80 | (letter & 0x3f))};
}

// The private letters that stand for a word, once its glyphs are loaded.
std::vector<std::string> signsOf(PanelSketch& sketch, const std::string& word) {
    sketch.bringLetters(word);
    const std::string shown = asShown(word);
    std::vector<std::string> signs;
    for (std::size_t i = 0; i + 2 < shown.size(); i += 3) { signs.push_back(shown.substr(i, 3)); }
    CAPTURE(word);
    for (const std::string& sign : signs) {
        unsigned letter = kFirstPrivate;
        while (letter <= kLastPrivate && utf8(letter) != sign) { ++letter; }
        CHECK(letter <= kLastPrivate);
        CHECK(isThere(letter));
    }
    return signs;
}

TEST_CASE("letters are half a degree high where the panel hangs, and Latin, Greek and Cyrillic are there") {
    REQUIRE_FALSE(vectorFont().empty());
    PanelSketch sketch;
    CHECK(sketch.font->complaint().empty());
    sketch.draw();
    const ImFontGlyph* capital = glyphOf('H');
    REQUIRE(capital != nullptr);
    const double distance_m = std::sqrt(0.45 * 0.45 + 0.1 * 0.1 + 0.9 * 0.9);
    const double height_m = (capital->Y1 - capital->Y0) * kPanelWidthMetres / kPanelPx.x;
    CHECK(glm::degrees(2.0 * std::atan(0.5 * kPanelWidthMetres / distance_m)) ==
          doctest::Approx(26.0).epsilon(0.005));
    CHECK(glm::degrees(std::atan(height_m / distance_m)) >= 0.5);
    for (const unsigned letter : {0x41, 0xe4, 0x159, 0x3a9, 0x436, 0x451, 0x1ea1, 0x301, 0x2013, 0x20ac}) {
        CHECK_MESSAGE(isThere(letter), letter);
    }
    // A box stands for what the font does not have yet, for bytes that are not UTF-8, and beyond 16 bits.
    REQUIRE(isThere(0x25a1));
    const ImFont& font = *ImGui::GetIO().Fonts->Fonts[0];
    CHECK(these(font.FindGlyph(0x4e2d), font.FindGlyph(0xfffd)) == these(glyphOf(0x25a1), glyphOf(0x25a1)));
}

TEST_CASE_FIXTURE(AtWork, "names bring their letters along, those of no font stay boxes, nothing moves") {
    PanelSketch sketch;
    const WidgetPlaces before = sketch.draw().places;
    CHECK_FALSE(isThere(0x5d0));
    // Hebrew, Georgian, private letters
    sketch.status.message = "\u05d0 \u10d0 \ufdff\uf8ff";
    CHECK(sketch.draw().places == before);
    CHECK(these(isThere(0x5d0), isThere(0x10d0), isThere(0xf8ff), isThere('A')) ==
          these(true, true, false, true));
    CHECK_FALSE(sketch.bringLetters(sketch.status.message));  // once
    CHECK_FALSE(sketch.bringLetters("\xff\xef\xbf\xbd plain"));
    // They stay, whatever is shown next. Chinese comes from the first font of the system that has it.
    const std::string chinese = "\xe6\xa3\xae\xe6\x9e\x97.ply";
    work.write(chinese, "x");
    sketch.showFolder(work.path);
    CHECK(sketch.draw().places.contains(chinese));
    CHECK(isThere(0x5d0));
    const std::vector<fs::path> further = furtherSystemFonts();
    if (std::ranges::any_of(further, [](const fs::path& file) {
            return fs::exists(file) && file.filename() != "DejaVuSans.ttf";
        })) {
        CHECK(isThere(0x68ee));
        CHECK(isThere(0x6797));
    } else {
        MESSAGE("skipped: no font of Chinese, Japanese and Korean is installed");
    }
    // However many glyphs there are, the texture keeps its size.
    for (unsigned page = 0; page < 8; ++page) {
        std::string text;
        for (unsigned i = 1000 * page; i < 1000 * (page + 1); ++i) { text += utf8(0x4e00 + i); }
        CHECK(sketch.bringLetters(text));
        const ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
        CHECK(glm::uvec2(atlas.TexWidth, atlas.TexHeight) == kLettersPx);
        CHECK(isThere('A'));
    }
}

TEST_CASE("the system says which fonts have a letter, and for no letter it says none") {
    CHECK(fontsWith({}).empty());
    CHECK(fontsWith({0xe000}).size() <= 1);  // a private letter
    const std::vector<SystemFont> fonts = fontsWith({0x5d0, 'A'});
    REQUIRE_FALSE(fonts.empty());
    for (const SystemFont& font : fonts) { CHECK(fs::exists(font.file)); }
}

TEST_CASE("Hebrew and Arabic are read from right to left and joined, also before a font has formed them") {
    for (const auto& [text, shown] :
         {std::pair("plain \u00e9 \u0416.ply", "plain \u00e9 \u0416.ply"),
          // Alef, bet and gimel within a path: gimel comes first, and the path keeps its order.
          std::pair("/a/\u05d0\u05d1\u05d2/b.ply", "/a/\u05d2\u05d1\u05d0/b.ply"),
          // Beh, alef: alef's final form, then beh's initial one. Lam and alef form one glyph.
          std::pair("\u0628\u0627", "\ufe8e\ufe91"), std::pair("\u0644\u0627", "\ufefb")}) {
        CHECK(asShown(text) == shown);
    }
    // Bytes that are not UTF-8 do no harm.
    CHECK(contains(asShown("\xd7\xff\xf0\x9f"), "\ufffd"));
}

TEST_CASE("letters that change with those beside them are formed and ordered by the font") {
    PanelSketch sketch;
    const std::string beh = "\xd8\xa8", alef = "\xd8\xa7";
    // All at once, so each glyph has one number.
    const std::string ha = "\xe0\xa4\xb9", hi = ha + "\xe0\xa4\xbf",
                      ksha = "\xe0\xa4\x95\xe0\xa5\x8d\xe0\xa4\xb7";
    sketch.bringLetters(fmt::format("{0} {0}{0} {1} {1}{0} \xd8\xb3\xd9\x84\xd8\xa7\xd9\x85 {2} {3} {4}", beh,
                                    alef, ha, hi, ksha));
    const auto of = [&](const std::string& word) { return signsOf(sketch, word); };
    const auto alone = of(beh), twice = of(beh + beh);
    REQUIRE(alone.size() == 1);
    REQUIRE(twice.size() == 2);
    CHECK(twice[0] != twice[1]);  // one joins to the right, the other to the left
    CHECK(std::ranges::find(twice, alone[0]) == twice.end());
    // Alef does not join to the letter after it; that letter is to its left.
    CHECK(of(alef + beh) == std::vector{alone[0], of(alef).at(0)});
    // Salam, with one glyph for lam and alef.
    CHECK(of("\xd8\xb3\xd9\x84\xd8\xa7\xd9\x85").size() == 3);
    if (fontsWith({0x939}).empty()) {
        MESSAGE("skipped: no font of Devanagari is installed");
        return;
    }
    // The vowel sign i is drawn before the letter after which it is read, and three letters form one glyph.
    REQUIRE(of(hi).size() == 2);
    CHECK(of(hi)[1] == of(ha).at(0));
    CHECK(of(ksha).size() == 1);
}

TEST_CASE("a word's signs are drawn, keep their order, and are nobody's private letters") {
    PanelSketch sketch;
    const std::string shalom = "\xd7\xa9\xd7\x9c\xd7\x95\xd7\x9d";
    const auto signs = signsOf(sketch, shalom);
    REQUIRE(signs.size() == 4);
    CHECK(asShown("/a/" + shalom + "/b.ply") == "/a/" + signs[0] + signs[1] + signs[2] + signs[3] + "/b.ply");
    const ImFontGlyph& drawn = *glyphOf(kFirstPrivate);
    CHECK(drawn.X1 > drawn.X0 + 3.0f);
    CHECK(drawn.Y1 == between(drawn.Y0 + 3.0f, ImGui::GetIO().Fonts->Fonts[0]->FontSize));
    CHECK(drawn.AdvanceX > 3.0f);
    const FontTexture texture = fontTexture();
    const glm::vec2 size_px(texture.size_px);
    const glm::uvec2 from(glm::vec2(drawn.U0, drawn.V0) * size_px),
        to(glm::vec2(drawn.U1, drawn.V1) * size_px);
    int most = 0;
    for (unsigned y = from.y; y < to.y; ++y) {
        for (unsigned x = from.x; x < to.x; ++x) { most = std::max<int>(most, texture.at({x, y})[3]); }
    }
    CHECK(most > 200);
    CHECK(asShown("\xee\x80\x80") == "\xef\xbf\xbd");
    // Beyond 16 bits: a letter of Old Italic, and bytes that begin like one.
    CHECK(signsOf(sketch, "\xf0\x90\x8c\x80").size() == 1);
    CHECK(wordsToForm("\xf0\x90\x8c/\xf4\xbf\xbf\xbf\xf0").empty());
    // However many words there are, their glyphs fit among the private letters.
    std::string many;
    for (int word = 0; word < 390; ++word) {
        for (int i = 0; i < 40; ++i) {
            many += fmt::format("\xd7{}", static_cast<char>(0x90 + (word * 7 + i * i) % 27));
        }
        many += ' ';
    }
    CHECK(sketch.bringLetters(many));
    CHECK_FALSE(sketch.bringLetters(many));
    CHECK(isThere('A'));
}

TEST_CASE_FIXTURE(AtWork, "without a usable font there is the small built-in one, and one line says why") {
    const std::string whole = vectorFont();
    work.write("text.ttf", "no font at all");
    work.write("short.ttf", whole.substr(0, whole.size() / 2));
    fs::create_directory(work.path / "folder.ttf");
    for (const char* name : {"nowhere.ttf", "text.ttf", "short.ttf", "folder.ttf"}) {
        CAPTURE(name);
        setenv("BINOSPLAT_FONT", (work.path / name).c_str(), 1);
        PanelSketch sketch;
        CHECK(sketch.font->complaint().starts_with("the panel is written in a small built-in font: "));
        CHECK(contains(sketch.font->complaint(), name));
        CHECK(sketch.font->complaint().find('\n') == std::string::npos);
        sketch.settings.page = PanelPage::kMethod;
        CHECK(sketch.click("shared").places.contains("Quit"));
        CHECK(sketch.settings.stereo.mode == Mode::kShared);
    }
    unsetenv("BINOSPLAT_FONT");
}

TEST_CASE("a font is taken only if the tables it has lie within it") {
    const std::string whole = vectorFont();
    REQUIRE(isFont(whole));
    for (const std::size_t bytes : {std::size_t{0}, std::size_t{4}, std::size_t{11}, std::size_t{12},
                                    std::size_t{40}, whole.size() - 1}) {
        CHECK_MESSAGE(!isFont(whole.substr(0, bytes)), bytes);
    }
    std::string nameless = whole;
    nameless.replace(nameless.find("cmap"), 4, "xxxx");
    CHECK_FALSE(isFont(nameless));
    CHECK_FALSE(isFont("ttcf" + whole.substr(4)));
    // A collection: the same tables, each 16 bytes farther from the beginning of the file.
    std::string moved = whole;
    for (std::size_t record = 12; record < 12 + 16 * (bigWordAt(whole, 4) >> 16); record += 16) {
        moved.replace(record + 8, 4, bigWord(bigWordAt(whole, record + 8) + 16));
    }
    CHECK(isFont("ttcf" + bigWord(0x00010000) + bigWord(1) + bigWord(16) + moved));
    // Of an unknown version, with no font, and with one that lies outside.
    for (const std::string& head :
         {bigWord(0x00030000) + bigWord(1) + bigWord(16), bigWord(0x00010000) + bigWord(0) + bigWord(16),
          bigWord(0x00010000) + bigWord(1) + bigWord(0x7fffffff)}) {
        CHECK_FALSE(isFont("ttcf" + head + moved));
    }
}

}  // SUITE(letters)
