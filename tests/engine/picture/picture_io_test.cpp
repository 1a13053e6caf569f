// Facts about image files: what is written can be read back, and a failed write leaves nothing behind.
#include "engine/picture/image_io.h"
#include "engine/picture/netpbm.h"
#include "tests/run_program.h"

SUITE(picture_io) {

// Every value differs from its neighbours; some lie outside 0 to 1.
Image makeRamp(glm::uvec2 size_px, int channels) {
    Image image{size_px, channels, {}};
    for (std::size_t i = 0; i < image.pixelCount() * channels; ++i) {
        image.values.push_back(static_cast<float>(i) * 0.37f - 1.0f);
    }
    return image;
}

TEST_CASE("a value becomes the nearest of a display's, whatever it is") {
    for (const auto& [value, level] :
         {std::pair(-1.0f, 0), {0.4f, 0}, {0.6f, 1}, {254.4f, 254}, {254.6f, 255}, {1e30f, 255}}) {
        CHECK(quantize(value / 255.0f) == level);
    }
    CHECK(these(quantize(std::numeric_limits<float>::infinity()),
                quantize(std::numeric_limits<float>::quiet_NaN())) == these(255, 0));
}

TEST_CASE_FIXTURE(AtWork, "a float picture comes back to the bit") {
    for (int channels : {1, 3, 4}) {
        const Image image = makeRamp({17, 33}, channels);
        if (channels != 4) {
            writePfm(work.path / "a.pfm", image);
            const Image back = readPicture(work.path / "a.pfm");
            CHECK(these(back.size_px, back.channels, back.values) ==
                  these(image.size_px, channels, image.values));
        }
        const auto files = writePicture(work.path / "a.b", PictureKind::kFloat, image);
        REQUIRE(!files.empty());
        CHECK(files.front() == work.path / (std::string("a.b") + extensionOf(PictureKind::kFloat)));
        const Image back = readPicture(files.front());
        CHECK(back.size_px == image.size_px);
        if (files.size() == 2) {
            CHECK(back.values == selectChannels(image, 0, 3).values);
            CHECK(readPicture(files.back()).values == selectChannels(image, 3, 1).values);
        } else {
            CHECK(back.values == image.values);
        }
    }
}

TEST_CASE_FIXTURE(AtWork, "a display picture comes back opaque, each value the nearest of 255") {
    // Eighths are exact in float32; in steps of 1/255 they are not, so rounding shows.
    Image display{{16, 9}, 4, {}};
    for (int i = 0; i < 16 * 9 * 4; ++i) { display.values.push_back(static_cast<float>(i % 9) / 8.0f); }
    const Image rgb = selectChannels(display, 0, 3);
    for (int channels : {1, 3}) {
        const Image image = selectChannels(display, 0, channels);
        writePnm(work.path / "a.ppm", image);
        const Image back = readPicture(work.path / "a.ppm");
        REQUIRE(back.values.size() == image.values.size());
        CHECK(back.channels == channels);
        for (std::size_t i = 0; i < back.values.size(); ++i) {
            CHECK(back.values[i] == static_cast<float>(quantize(image.values[i])) / 255.0f);
        }
    }
    const auto files = writePicture(work.path / "a", PictureKind::kDisplay, display);
    REQUIRE(files.size() == 1);
    const Image back = readPicture(files.front());
    REQUIRE(back.channels == 3);
    for (std::size_t i = 0; i < rgb.values.size(); ++i) {
        CHECK(std::lround(back.values[i] * 255.0f) == quantize(rgb.values[i]));
    }
}

TEST_CASE_FIXTURE(AtWork, "a write that fails leaves nothing") {
    for (const PictureKind kind : {PictureKind::kFloat, PictureKind::kDisplay}) {
        CHECK_THROWS_AS(writePicture(work.path / "missing" / "a", kind, makeRamp({4, 4}, 4)), Error);
    }
    CHECK_THROWS_AS(writePicture(work.path / "a", PictureKind::kFloat, Image{{4, 4}, 4, {1.0f}}), Error);
    CHECK(work.isEmpty());
}

#ifdef BINOSPLAT_HAS_PNG

TEST_CASE_FIXTURE(AtWork, "colours of a picture with alpha are read as they are stored") {
    // One pixel: 200, 100, 50, and an alpha of 128.
    constexpr unsigned char kPng[] = {0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d,
                                      0x49, 0x48, 0x44, 0x52, 0x00, 0x00, 0x00, 0x01, 0x00, 0x00, 0x00, 0x01,
                                      0x08, 0x06, 0x00, 0x00, 0x00, 0x1f, 0x15, 0xc4, 0x89, 0x00, 0x00, 0x00,
                                      0x0d, 0x49, 0x44, 0x41, 0x54, 0x78, 0x9c, 0x63, 0x38, 0x91, 0x62, 0xd4,
                                      0x00, 0x00, 0x05, 0x35, 0x01, 0xdf, 0x73, 0x62, 0xe3, 0xdb, 0x00, 0x00,
                                      0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};
    work.write("a.png", std::string(std::begin(kPng), std::end(kPng)));
    const Image image = readPicture(work.path / "a.png");
    REQUIRE(image.values.size() == 4);
    CHECK(these(image.values[0], image.values[1], image.values[2]) == these(doctest::Approx(200.0 / 255.0),
                                                                            doctest::Approx(100.0 / 255.0),
                                                                            doctest::Approx(50.0 / 255.0)));
}

#ifdef BINOSPLAT_OPENIMAGEIO
TEST_CASE_FIXTURE(AtWork, "a volume is no picture") {
    // DDS of 2x2x2 pixels of four bytes: size of the header, what it contains, height, width, bytes per row,
    // depth, mips, 11 unused words, the pixel format (size of its header, RGB with alpha, no code, bits,
    // masks), and the flag of a volume.
    constexpr std::array<std::uint32_t, 31> kHeader{
        124, 0x801007, 2,  2,    8, 2,  1,    0,      0,        0,          0,      0,        0, 0, 0, 0,
        0,   0,        32, 0x41, 0, 32, 0xff, 0xff00, 0xff0000, 0xff000000, 0x1008, 0x200000, 0, 0, 0};
    const std::string header(reinterpret_cast<const char*>(kHeader.data()), sizeof kHeader);
    work.write("a.dds", "DDS " + header + std::string(32, 'x'));
    CHECK(errorOf([&] { (void)readPicture(work.path / "a.dds"); }) ==
          (work.path / "a.dds").string() +
              ": has 2x2x2 pixels of 4 channels, must be a flat picture of up to 2^30 values");
}
#endif

#endif

TEST_CASE_FIXTURE(AtWork, "files that end early or are something else are errors") {
    writePfm(work.path / "a.pfm", makeRamp({8, 8}, 3));
    fs::resize_file(work.path / "a.pfm", fs::file_size(work.path / "a.pfm") - 1);
    work.write("b.pfm", "not an image");
    work.write("huge.ppm", "P6\n4000000000 4000000000\n255\nx");
    for (const char* name : {"a.pfm", "b.pfm", "huge.ppm", "none.exr"}) {
        CHECK_THROWS_AS(readPicture(work.path / name), Error);
    }
    const auto checkError = [&](const std::string& name, const std::string& bytes,
                                const std::string& message) {
        work.write(name, bytes);
        CHECK(errorOf([&] { (void)readPicture(work.path / name); }) == (work.path / name).string() + message);
    };
    // Memory for what a header promises is not reserved before the file is known to contain it.
    checkError("promise.pfm", "PF\n30000 30000\n-1\nxyz", ": ends after 3 of 10800000000 bytes of pixels");
    checkError("promise.ppm", "P6\n30000 30000\n255\nxyz", ": ends after 3 of 2700000000 bytes of pixels");
    for (const char* name : {"p.png", "p.jpg", "p.pfm", "p.ppm"}) {
        checkError(
            name, "version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 1\n",
            ": is a Git LFS pointer, three lines in place of the file: must be fetched (`git lfs pull`)");
    }
}

}  // SUITE(picture_io)
