// Facts about what `bench` measures of frames: alone, along a head's motion, and beside photographs.
#include "engine/picture/image_io.h"
#include "tests/app/bench/benches.h"
#include "tests/app/scores/lpips_weights.h"

SUITE(bench_runs) {

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST_CASE("a bench writes a table, JSON, CSV and a plot, and compares methods by the origin of their pixels") {
    const Bench bench;
    writeFloats(bench.path / "w.bin", makeLpipsWeights(9));
    bench.write("b.toml",
                "[bench]\nrepeats = 2\nwarm-up = 0\ntwin = true\nscores = [\"ssim\", \"lpips\"]\nlpips = \"w.bin\"\n"
                "[[methods]]\nname = \"half\"\nmode = \"predicted\"\nbudget = 0.5\n"
                "[[methods]]\nname = \"small\"\nmode = \"shared\"\nresolution = 0.5\n"
                "[[series]]\nname = \"pixels\"\nsizes = [\"96x96\", \"16x48\"]\n");
    const std::string table = bench.go("bench builtin:step-edge --out out --config b.toml").output;
    const nlohmann::json results = bench.results("out/bench.json");
    REQUIRE(results.size() == 12);
    CHECK(contains(table, "rasterize"));
    CHECK(contains(table, "splats (2DGS)"));
    CHECK(contains(table, "LPIPS"));
    const std::string csv = bench.bytesOf("out/bench.csv");
    CHECK(contains(csv.substr(0, csv.find('\n')), ",all lpips,"));
    CHECK(bench.holds("out/bench.svg"));
    CHECK(std::distance(fs::directory_iterator(bench.path / "out"), {}) == 3);
    CHECK(these(results[0]["ratio_to_two_pass"], results[0]["frames"], results[0]["backbone"], results[1]["mode"]) ==
          these(1.0, 2, "2DGS", "shared"));
    // Which of the two is faster is up to the clock; the faster one has no error and nothing beats it.
    CHECK((results[0]["on_front"] == true || results[1]["on_front"] == true));
    CHECK(!results[1].contains("affiliated_against_full"));
    CHECK(these(results[2]["method"], results[2]["stage_ms"].contains("patch"), results[3]["resolution"]) == these("half", true, 0.5));
    CHECK(results[3]["affiliated_against_full"].size() == 1);
    CHECK(results[3]["affiliated_against_full"]["all"]["psnr_db"] > 20.0);
    CHECK(these(results[4].contains("ratio_to_twin"), results[5]["mode"]) == these(true, "twin"));
    CHECK(results[5]["counters"]["square_box_tile_pairs"] > results[4]["counters"]["tile_pairs"]);
    const nlohmann::json& quality = results[2]["affiliated_against_full"];
    CHECK(quality["all"]["pixels"] == 96 * 96);
    CHECK(quality["all"]["psnr_db"] > 25.0);
    CHECK(quality["all"]["ssim"] > 0.8);
    CHECK(quality["all"]["lpips"] > 0.0);
    CHECK(!quality["reprojected"].contains("lpips"));
    CHECK(quality["patched"]["mean_square"] < 1e-6);
    // Too small for the network: the other scores are there.
    CHECK(!results[8]["affiliated_against_full"]["all"].contains("lpips"));
    CHECK(results[8]["affiliated_against_full"]["all"].contains("psnr_db"));

    // Scores that nobody asks for are in none of them.
    bench.write("b.toml", "[bench]\nmodes = [\"reproject\"]\nrepeats = 1\nwarm-up = 0\nscores = [\"psnr\"]\n");
    const std::string plain = bench.go("bench builtin:slanted-wall --size 48x48 --out plain --config b.toml").output;
    CHECK(!contains(plain, "LPIPS"));
    CHECK(!contains(bench.bytesOf("plain/bench.csv"), "lpips"));
    const nlohmann::json all = bench.results("plain/bench.json")[2]["affiliated_against_full"]["all"];
    CHECK(!all.contains("lpips"));
    CHECK(!all.contains("ssim"));
}

const std::string kAlongMotion =
    "bench builtin:step-edge --size 48x48 --config b.toml --motion m.csv --from 0.1 --seconds 0.1 --rate 40 --out out";
const std::string kBesidePhotos = "bench builtin:step-edge --cameras c.json --config b.toml --photos photos --out out";

// Walks, or stands before the photograph of a scene that is the scene itself, seen by one eye in the middle.
struct Walk : Bench {
    Walk() {
        write("m.csv", "time_s,x,y,z,qx,qy,qz,qw\n0,0,0,0,0,0,0,1\n0.1,0.02,0,0,0,0,0,1\n0.2,0.04,0,0,0,0,0,1\n");
        write("c.json", R"([{"img_name": "a", "width": 48, "height": 40, "fx": 48, "fy": 48, "position": [0,0,0],
                             "rotation": [[1,0,0],[0,1,0],[0,0,1]]}])");
    }
    void takePhoto() const {
        go("render builtin:step-edge --cameras c.json --mode mono --out photo");
        const std::string extension = extensionOf(PictureKind::kDisplay);
        fs::create_directory(path / "photos");
        fs::rename(path / "photo" / ("mono" + extension), path / "photos" / ("a" + extension));
    }
};

TEST_CASE("a bench plays a part of a head's motion") {
    const Walk bench;
    bench.write("b.toml", "[bench]\nmodes = [\"predicted\"]\n[[methods]]\nname = \"shared\"\nmode = \"shared\"\nresolution = [0.4, 0.5]\n");
    bench.go(kAlongMotion + " --every 3");
    const nlohmann::json results = bench.results("out/motion.json");
    REQUIRE(results.size() == 5);
    CHECK(results[0]["frames"] == 2);
    CHECK(!results[0].contains("psnr_db"));
    CHECK(results[4]["method"] == "shared@0.5");
    CHECK(results[4]["psnr_db"]["run"] > 20.0);
    CHECK(results[4]["bad_share"]["worst"] >= results[4]["bad_share"]["mean"]);
    CHECK(results[4]["rival"] >= 0.0);
    CHECK(results[0]["full_change"]["p99"] > 0.0);
    CHECK(results[1]["work_rendered"]["median"] == 1.0);
    const nlohmann::json& predicted = results[2];
    CHECK(predicted["mode"] == "predicted");
    CHECK(predicted["flicker"]["median"] > 0.0);
    CHECK(predicted["psnr_db"]["run"] > 20.0);
    CHECK(predicted["psnr_db"]["worst"] <= predicted["psnr_db"]["run"]);
    CHECK(predicted["work_rendered"]["median"] < 1.0);
    // The dominant eye has no error, the other one has.
    std::istringstream csv(bench.bytesOf("out/motion.csv"));
    std::string header, row;
    std::getline(csv, header);
    CHECK(header.ends_with("psnr_left_db,psnr_right_db,mse_left,mse_right,flicker_left,flicker_right,work_rendered,pixels_warped"));
    while (std::getline(csv, row) && row.find(",predicted,") == std::string::npos) {}
    Names cells;
    std::istringstream split(row);
    for (std::string cell; std::getline(split, cell, ',');) { cells.push_back(cell); }
    REQUIRE(cells.size() >= static_cast<std::size_t>(std::count(header.begin(), header.end(), ',')) + 1);
    CHECK(std::stod(cells[cells.size() - 6]) == 0.0);
    CHECK(std::stod(cells[cells.size() - 5]) > 0.0);
    CHECK(std::stod(cells.back()) > 0.0);
    CHECK(bench.holds("out/motion.svg"));
    bench.checkRefused("bench builtin:one-splat --motion none.csv --out none", 1, "none.csv");
}

TEST_CASE("with a headset a bench along a motion also tells what is seen through its lenses, and with a bound what is far under it") {
    const Walk bench;
    bench.write("b.toml",
                "[bench]\nmodes = [\"shared\"]\nwarm-up = 0\n[[methods]]\nname = \"low\"\nmode = \"shared\"\nresolution = 0.4\n"
                "[[methods]]\nname = \"bound\"\nmode = \"temporal\"\nerror-bound = 28\n");
    const std::string table = bench.go(kAlongMotion + " --every 2 --headset quest3").output;
    CHECK(contains(table, "seen through the lenses"));
    CHECK(contains(table, "more than 2 dB under its bound"));
    const nlohmann::json results = bench.results("out/motion.json");
    REQUIRE(results.size() == 4);
    CHECK(!results[1].contains("seen"));  // no error
    const nlohmann::json &low = results[2], &bound = results[3];
    // At 48 pixels for 94 degrees an eye sees more than there is everywhere: what differs is the share of flat pictures' borders.
    CHECK(low["bad_share"]["mean"] > 0.0);
    CHECK(low["seen"]["bad_share"]["mean"] > 0.0);
    CHECK(low["seen"]["worst_tiles_db"] > 10.0);
    CHECK(low["seen"]["bad_share"] != low["bad_share"]);
    CHECK(!low.contains("under_bound"));
    CHECK(bound["under_bound"]["tiles_kept"] > 0);
    CHECK(bound["under_bound"]["share"] <= bound["under_bound"]["worst"]);
    std::istringstream csv(bench.bytesOf("out/motion.csv"));
    std::string header, row;
    std::getline(csv, header);
    CHECK(header.ends_with("pixels_warped,tiles_kept,tiles_under_bound,seen_bad_share,seen_worst_tiles_db,seen_edge,seen_seam,seen_rival"));
    while (std::getline(csv, row)) { CHECK(std::ranges::count(row, ',') >= std::ranges::count(header, ',')); }
}

TEST_CASE("of frames that may take next to nothing the controller lowers resolution and bound, and says so of each") {
    const Walk bench;
    bench.write("b.toml", "[bench]\nmodes = [\"temporal\"]\nwarm-up = 0\n");
    bench.go("bench builtin:step-edge --size 48x48 --config b.toml --motion m.csv --rate 60 --frame-time 0.001 --out out");
    std::istringstream csv(bench.bytesOf("out/motion.csv"));
    std::vector<std::string> ends;
    for (std::string row; std::getline(csv, row);) {
        if (row.find(",temporal,") != std::string::npos) { ends.push_back(row); }
        CHECK((ends.size() > 0 || row.ends_with("error_bound_db") || row.ends_with(",,")));
    }
    REQUIRE(ends.size() >= 10);
    CHECK(ends.front().ends_with(",1,30"));
    CHECK(ends.back().ends_with(",0.6,20"));
    bench.checkRefused("bench builtin:step-edge --frame-time 5 --out none", 2, "without --motion");
}

TEST_CASE("a bench compares with photographs") {
    const Walk bench;
    bench.write("b.toml", "[bench]\nmodes = [\"reproject\"]\n");
    writeFloats(bench.path / "w.bin", makeLpipsWeights(9));
    bench.takePhoto();
    bench.go(kBesidePhotos);
    const nlohmann::json results = bench.results("out/photos.json");
    REQUIRE(results.size() == 3);
    CHECK(results[1]["method"] == "shared");
    CHECK(results[1]["psnr_db_to_photo"] > 50.0);  // 8 bits
    CHECK(results[1]["psnr_db_lost"] == 0.0);
    CHECK(results[2]["psnr_db_lost"] > 0.0);
    CHECK(!results[2].contains("lpips_to_photo"));
    bench.go(kBesidePhotos + " --lpips w.bin");
    const nlohmann::json with_lpips = bench.results("out/photos.json");
    CHECK(with_lpips[1]["lpips_lost"] == 0.0);
    CHECK(with_lpips[2]["lpips_to_photo"] > with_lpips[1]["lpips_to_photo"]);
    fs::remove_all(bench.path / "photos");
    bench.checkRefused(kBesidePhotos, 1, "photos/a");
}

TEST_CASE("a bench of every mode that makes one eye from the other: beside the full render, along a motion, beside a photograph" *
          nightly()) {
    const Walk bench;
    bench.takePhoto();
    bench.write("b.toml", "[bench]\nmodes = [\"reproject\", \"paper\", \"predicted\"]\nrepeats = 1\nwarm-up = 0\n");
    bench.go("bench builtin:step-edge --size 96x96 --config b.toml --out out");
    bench.go(kAlongMotion);
    bench.go(kBesidePhotos);
    const nlohmann::json alone = bench.results("out/bench.json"), moved = bench.results("out/motion.json"),
                         beside = bench.results("out/photos.json");
    for (std::size_t i = 0; i < 3; ++i) {
        const std::string mode = std::array{"reproject", "paper", "predicted"}[i];
        CAPTURE(mode);
        // Behind two-pass and shared.
        REQUIRE(std::min({alone.size(), moved.size(), beside.size()}) == 5);
        const nlohmann::json& quality = alone[2 + i]["affiliated_against_full"];
        CHECK(alone[2 + i]["mode"] == mode);
        CHECK(quality["all"]["psnr_db"] > 20.0);
        CHECK(quality.contains("patched") == (mode != "reproject"));
        CHECK(moved[2 + i]["mode"] == mode);
        CHECK(moved[2 + i]["psnr_db"]["run"] > 20.0);
        CHECK(moved[2 + i]["work_rendered"]["median"] < 1.0);
        CHECK(moved[2 + i]["flicker"]["median"] > 0.0);
        CHECK(beside[2 + i]["method"] == mode);
        CHECK(beside[2 + i]["psnr_db_lost"] > 0.0);
        CHECK(beside[2 + i]["psnr_db_to_photo"] > 20.0);
    }
}

}  // SUITE(bench_runs)
