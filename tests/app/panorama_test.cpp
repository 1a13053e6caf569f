// Facts about panoramas: where things are in them, that no seam shows, and what their files tell players.
#include "app/scores/metrics.h"
#include "engine/picture/image_io.h"
#include "engine/picture/panorama_tags.h"
#include "tests/engine/picture/pictures.h"
#include "tests/run_program.h"
#include "tests/xr/simulated/installed.h"

SUITE(panorama) {

constexpr double kPi = std::numbers::pi;

// 3D Gaussians, whose shape depends on the camera's axes; seen from a place within the room.
const std::string kPlace = "--eye 0.02,-1.5,1.2 --up 0,-1,0 ";

// How a picture differs from another one turned left by `shift` columns: the mean square of the step of this
// difference from one column to the next.
double stepAt(const Image& a, const Image& b, std::uint32_t shift, std::uint32_t column) {
    double sum = 0.0;
    for (std::uint32_t y = 0; y < a.size_px.y; ++y) {
        const auto differs = [&](std::uint32_t x) {
            return colourOf(a, x % a.size_px.x, y) - colourOf(b, (x + shift) % b.size_px.x, y);
        };
        const glm::vec3 step = differs(column + 1) - differs(column);
        sum += static_cast<double>(glm::dot(step, step)) / 3.0;
    }
    return sum / a.size_px.y;
}

// The bytes beginning with the first box or chunk that has these four letters.
std::string after(const std::string& bytes, const std::string& letters) {
    const std::size_t at = bytes.find(letters);
    return at == std::string::npos ? "" : bytes.substr(at + 4);
}

TEST_CASE("what the faces show of a direction, the panorama shows there, also where they meet") {
    const auto seenIn = [](const glm::dvec3& direction) {
        return glm::vec3(0.5 + 0.4 * glm::normalize(direction));
    };
    for (const double width_rad : {kPi, 2.0 * kPi}) {
        const Panorama panorama{width_rad,
                                {static_cast<std::uint32_t>(std::lround(64.0 * width_rad / kPi)), 64}};
        std::vector<Image> faces;
        for (const Eye& face : facesOf(panorama, {})) {
            const Intrinsics& k = face.intrinsics;
            faces.push_back(makePicture(
                face.size_px,
                [&](double x, double y) {
                    return seenIn(face.world_from_camera.orientation *
                                  glm::dvec3((x + 0.5 - k.cx) / k.fx, (y + 0.5 - k.cy) / k.fx, 1.0));
                },
                4));
        }
        const Image seen = panoramaOf(panorama, faces);
        const Image expected = makePicture(
            seen.size_px,
            [&](double x, double y) {
                const double right = ((x + 0.5) / seen.size_px.x - 0.5) * width_rad,
                             down = ((y + 0.5) / seen.size_px.y - 0.5) * kPi;
                return seenIn(
                    {std::sin(right) * std::cos(down), std::sin(down), std::cos(right) * std::cos(down)});
            },
            4);
        const double worst = compare(seen, expected, 4).largest;
        CHECK(worst < 5e-4);  // the mean over a pixel is not the value at its middle
    }
}

TEST_CASE_FIXTURE(AtWork, "where faces of a picture of all around meet, nothing stands out") {
    const auto around = [&](const std::string& look) {
        work.go("render builtin:atelier --projection 360 --size 256x128 " + kPlace + look + " --out around");
        return readPicture(work.path / "around/mono" BINOSPLAT_FLOAT_EXTENSION);
    };
    // An eighth of a turn to the right: edges of faces and their middles change places.
    const Image ahead = around("--look 0.02,-1.5,2.2"), aside = around("--look 1.02,-1.5,2.2");
    REQUIRE(ahead.size_px == glm::uvec2(256, 128));
    const Image nothing{ahead.size_px, 4, std::vector<float>(ahead.values.size(), 0.0f)};
    double edges = 0.0, own = 0.0;
    for (std::uint32_t edge = 32; edge < 256; edge += 64) {
        edges += stepAt(ahead, aside, 256 - 32, edge - 1);
        own += stepAt(ahead, nothing, 0, edge - 1);
    }
    MESSAGE("steps at the edges of faces: " << edges / own << " of the picture's own");
    CHECK(edges < 0.5 * own);
}

TEST_CASE_FIXTURE(AtWork, "each eye sees what two eyes at its place would see") {
    const auto render = [&](const char* eye, double x, double apart) {
        work.go(
            fmt::format("render builtin:atelier --projection vr180 --layout separate --size 256x256 --out "
                        "around --up 0,-1,0 --eye {0},-1.5,1.2 --look {0},-1.5,2.2 --ipd {1}",
                        x, apart));
        return readPicture(work.path / "around" / (std::string(eye) + BINOSPLAT_FLOAT_EXTENSION));
    };
    for (const auto& [eye, aside] : {std::pair("left", -0.15), std::pair("right", 0.15)}) {
        const Image seen = render(eye, 0.02, 0.3);
        const double own = compare(seen, render(eye, 0.02 + aside, 0.0)).mean_square,
                     other = compare(seen, render(eye, 0.02 - aside, 0.0)).mean_square;
        CHECK(own < 0.2 * other);
    }
}

TEST_CASE_FIXTURE(AtWork, "a picture of all around tells galleries so, and is a picture still") {
    work.go("render builtin:one-splat --projection 360 --size 64x32 --out out");
#ifdef BINOSPLAT_HAS_PNG
    const std::string png = work.bytesOf("out/mono.png");
    const std::string text = after(png, "iTXt");
    CHECK(text.starts_with("XML:com.adobe.xmp" + std::string(5, '\0')));
    for (const char* said : {"ProjectionType=\"equirectangular\"", "FullPanoWidthPixels=\"64\"",
                             "CroppedAreaLeftPixels=\"0\""}) {
        CHECK(contains(text, said));
    }
    CHECK(readPicture(work.path / "out/mono.png").size_px == glm::uvec2(64, 32));
    // An eye's picture of the half before it has a quarter missing on each side.
    work.go("render builtin:one-splat --projection vr180 --layout separate --size 32x32 --out half");
    for (const char* eye : {"left", "right"}) {
        const std::string half = after(work.bytesOf(fmt::format("half/{}.png", eye)), "iTXt");
        for (const char* said : {"FullPanoWidthPixels=\"64\"", "FullPanoHeightPixels=\"32\"",
                                 "CroppedAreaImageWidthPixels=\"32\"", "CroppedAreaImageHeightPixels=\"32\"",
                                 "CroppedAreaLeftPixels=\"16\"", "CroppedAreaTopPixels=\"0\""}) {
            CHECK_MESSAGE(contains(half, said), eye << ": " << said);
        }
    }
    // The same for JPEG, if the build has a library for it: the tags are in the second segment.
    if (work.holds("out/mono.jpg")) {
        const std::string jpg = work.bytesOf("out/mono.jpg"), xmp = "http://ns.adobe.com/xap/1.0/";
        REQUIRE(jpg.starts_with("\xff\xd8\xff\xe0"));
        const std::size_t second = std::size_t{4} + bigWordAt(jpg, 2) % 65536;
        CHECK(jpg.substr(second, 2) == "\xff\xe1");
        CHECK(jpg.substr(second + 4, xmp.size()) == xmp);
        const std::size_t third = second + 2 + bigWordAt(jpg, second) % 65536;
        CHECK(jpg.substr(third, 1) == "\xff");
        CHECK(contains(jpg.substr(second, third - second), "FullPanoWidthPixels=\"64\""));
        CHECK(compare(readPicture(work.path / "out/mono.jpg"), readPicture(work.path / "out/mono.png"))
                  .psnrDb() > 35.0);
    }
#ifdef BINOSPLAT_OPENIMAGEIO
    CHECK(work.holds("out/mono.jpg"));
#endif
#endif
    work.checkRefused("render builtin:one-splat --projection 360 --size 64x64 --out no", 1,
                      "--size is 64x64, must be twice as wide as high");
    work.checkRefused("render builtin:one-splat --projection vr180 --mode paper --out no", 2,
                      "its mode is shared");
}

// A box of an MP4.
std::string box(const std::string& type, const std::string& content) {
    return bigWord(static_cast<std::uint32_t>(8 + content.size())) + type + content;
}
// The parts of a film's index, as ffmpeg writes it, that matter here.
std::string indexOf(const std::string& tags) {
    const std::string picture =
        std::string(78, 'p') + box("avcC", "decoder") + tags + box("pasp", "12345678");
    const std::string table =
        box("stsd", std::string(7, '\0') + '\1' + box("avc1", picture)) + box("stts", "times");
    return box("moov", box("mvhd", "m") +
                           box("trak", box("tkhd", "t") +
                                           box("mdia", box("mdhd", "d") + box("minf", box("stbl", table)))) +
                           box("udta", "u"));
}

TEST_CASE("the boxes that say how a film was projected lie after the decoder's, and those around grow") {
    const std::string none(4, '\0'), quarter = "\x40" + std::string(3, '\0');
    const auto sphere = [&](const std::string& side) {
        return box("sv3d", box("svhd", none + "binosplat" + '\0') +
                               box("proj", box("prhd", std::string(16, '\0')) +
                                               box("equi", none + none + none + side + side)));
    };
    CHECK(withFilmTags(indexOf(""), {FilmEyes::kSideBySide, kPi}) ==
          indexOf(box("st3d", none + '\2') + sphere(quarter)));
    CHECK(withFilmTags(indexOf(""), {FilmEyes::kOne, 2.0 * kPi}) == indexOf(sphere(none)));
    CHECK(withFilmTags(indexOf(""), {FilmEyes::kTopBottom, {}}) == indexOf(box("st3d", none + '\1')));
    CHECK(!errorOf([] { (void)withFilmTags(box("moov", "none"), {}); }).empty());
}

TEST_CASE_FIXTURE(AtWork, "a path becomes a film with both eyes; without ffmpeg one line says so") {
    work.write("poses.csv",
               "time_s,x,y,z,qx,qy,qz,qw\n0,0,0,0,0,0,0,1\n0.04,0.01,0,0,0,0,0,1\n0.08,0.02,0,0,0,0,0,1\n");
    // A stand-in for the encoder: it leaves a film, and records how it was called.
    work.write("film", box("ftyp", "isom") + box("mdat", "pictures") + indexOf(""));
    fs::create_directories(work.path / "bin");
    const std::string here = work.path.string();
    work.write("bin/ffmpeg", "#!/bin/sh\necho \"$@\" >" + here +
                                 "/called\nfor film; do :; done\n[ \"$film\" = -version ] || cp " + here +
                                 "/film \"$film\"\n");
    fs::permissions(work.path / "bin/ffmpeg", fs::perms::owner_all);
    const std::string film = "render builtin:one-splat --path poses.csv --size 32x32 --video ";
    work.go(film + "--projection vr180 --out out", "PATH=" + here + "/bin:" + environment("PATH"));
    const std::string called = work.bytesOf("called");
    CHECK(contains(called, "-framerate 25 "));
    CHECK(contains(called, "frame_%06d_stereo"));
    const std::string bytes = work.bytesOf("out/video.mp4");
    CHECK(bigWordAt(after(bytes, "equi"), 12) == 0x40000000u);
    CHECK(after(bytes, "st3d").at(4) == '\2');
    CHECK(
        readPicture(work.path / (std::string("out/frame_000002_stereo") + extensionOf(PictureKind::kDisplay)))
            .size_px == glm::uvec2(64, 32));
    work.checkRefused(film + "--out no", 1, "ffmpeg", "PATH=" + here);
    CHECK(!work.holds("no"));
    // The encoder itself makes a film that players read so.
    if (!isInstalled("ffmpeg", "ffmpeg") || !isInstalled("ffprobe", "ffmpeg")) { return; }
    work.go(film + "--projection vr180 --out real");
    const std::string read =
        work.runCommand("ffprobe -v error -count_frames -show_streams real/video.mp4").output;
    for (const char* said : {"codec_name=h264\n", "width=64\n", "nb_read_frames=3\n", "frame_rate=25/1\n",
                             "type=side by side\n", "projection=tiled equirectangular\n"}) {
        CHECK_MESSAGE(contains(read, said), read);
    }
    work.go(film + "--layout sbs --out flat");
    const std::string flat = work.runCommand("ffprobe -v error -show_streams flat/video.mp4").output;
    for (const char* said : {"width=64\n", "height=32\n", "type=side by side\n"}) {
        CHECK_MESSAGE(contains(flat, said), flat);
    }
    CHECK_FALSE(contains(flat, "projection="));
}

}  // SUITE(panorama)
