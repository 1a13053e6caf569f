// The program with moving scenes: pictures along a path, what is reported, and what is refused.
#include "engine/picture/image_io.h"
#include "tests/engine/stream/moving_frames.h"
#include "tests/run_program.h"

SUITE(moving_program) {

const std::string kCamera = " --size 64x64 --eye 0.4,-1.6,0.6 --look 0,-1.1,4 --up 0,-1,0 --mode shared ";
const std::string kPath = kCamera + "--path still.csv --rate 10 ";
constexpr int kFrames = 4;

struct Sliding : Workplace {
    Sliding() {
        writeSliding((path / "slide").string(), kFrames, 2000);
        std::string still = "timestamp_us,x,y,z,qx,qy,qz,qw\n";
        for (int i = 0; i <= 4; ++i) { still += fmt::format("{},0,0,0,0,0,0,1\n", 100000 * i); }
        write("still.csv", still);
    }
    [[nodiscard]] nlohmann::json report(const std::string& folder) const { return nlohmann::json::parse(bytesOf(folder + "/report.json")); }
    [[nodiscard]] std::string picture(const std::string& name) const { return bytesOf(name + extensionOf(PictureKind::kDisplay)); }
    // As render makes it of one file.
    [[nodiscard]] std::string pictureOfFrame(int frame, const std::string& eye) const {
        const std::string out = fmt::format("whole{}", frame);
        if (!holds(out)) { go(fmt::format("render slide/frame_{:04}.ply{}--out {}", frame + 1, kCamera, out)); }
        return picture(out + "/" + eye);
    }
};

TEST_CASE_FIXTURE(Sliding, "a picture shows the first frame, and along a path time goes on with the frames, around and around") {
    go("render slide" + kCamera + "--out first");
    CHECK(picture("first/left") == pictureOfFrame(0, "left"));
    CHECK(these(report("first")["counters"]["scene_frames_late"], report("first")["options"]["scene-rate"]) == these(0, 30.0));

    go("render slide" + kPath + "--scene-rate 10 --out path");
    for (int i = 0; i < 5; ++i) {
        CAPTURE(i);
        CHECK(picture(fmt::format("path/frame_{:06}_left", i)) == pictureOfFrame(i % kFrames, "left"));
    }
    CHECK(report("path")["frames"][3]["counters"]["splats_resident"] == 2000);
    // Half as fast, from the middle on: time begins where the path does.
    go("render slide" + kPath + "--from 0.2 --scene-rate 5 --out half");
    for (int i = 0; i < 3; ++i) { CHECK(picture(fmt::format("half/frame_{:06}_right", i)) == pictureOfFrame(i / 2, "right")); }
    // What lies between.
    go("render slide" + kPath + "--scene-rate 5 --scene-blend --out blend");
    CHECK(picture("blend/frame_000002_left") == pictureOfFrame(1, "left"));
    CHECK(picture("blend/frame_000003_left") != pictureOfFrame(1, "left"));
    CHECK(picture("blend/frame_000003_left") != pictureOfFrame(2, "left"));
}

TEST_CASE_FIXTURE(Sliding, "bench measures a moving scene along a motion, and other commands take its first frame") {
    write("few.toml", "[bench]\nmodes = [\"two-pass\", \"temporal\"]\nscores = [\"psnr\"]\n");
    const std::string bench = "bench slide --size 64x64 --eye 0.4,-1.6,0.6 --look 0,-1.1,4 --up 0,-1,0 --config few.toml ";
    go(bench + "--motion still.csv --rate 10 --scene-rate 10 --seconds 0.3 --out moved");
    const std::string csv = bytesOf("moved/motion.csv");
    CHECK(csv.find(",scene_frames_late,moved_share,psnr_moved_db\n") != std::string::npos);
    CHECK(std::count(csv.begin(), csv.end(), '\n') == 1 + 3 * 3);  // with shared, which is always there
    write("few.toml", "[bench]\nmodes = [\"shared\"]\nscores = [\"none\"]\nwarm-up = 0\nrepeats = 1\n");
    go(bench + "--out still");
    go("convert slide first.ply");
    go("convert slide/frame_0001.ply same.ply");
    CHECK(bytesOf("first.ply") == bytesOf("same.ply"));
    CHECK(go("info slide").output.find("2000") != std::string::npos);
}

TEST_CASE_FIXTURE(Sliding, "hostile folders end in one line") {
    const std::string third = "slide/frame_0003.ply", along = "render slide" + kPath + "--scene-rate 10 --out ";
    // Nobody who does not come to it is told of a broken file.
    write(third, "ply\nformat ascii 1.0\nelement vertex 3\nend_header\n");
    checkRefused(along + "out", 1, "frame_0003.ply");
    CHECK_FALSE(holds("out"));
    go(along + "begin --seconds 0.1");
    // Of another format, or another kind of splat.
    write(third, std::string(32, '\x40'));
    checkRefused(along + "out", 1, "frame_0003.ply");
    fs::remove(path / third);
    CHECK(go(along + "out").output.find("1 of 4 numbered files are missing, the first after frame_0002.ply") != std::string::npos);
    CHECK(picture("out/frame_000002_left") == pictureOfFrame(1, "left"));
    for (const int frame : {1, 2, 4}) {
        fs::rename(path / fmt::format("slide/frame_{:04}.ply", frame), path / fmt::format("slide/{}", frame));
    }
    go("render slide" + kCamera + "--out out2");
    checkRefused("render slide" + kCamera + "--splat-budget 100 --out o", 1, "no levels of detail");
    checkRefused("render slide" + kCamera + "--lod 1 --out o", 1, "no levels of detail");
}

}  // SUITE(moving_program)
