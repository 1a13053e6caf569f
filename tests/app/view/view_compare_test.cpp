// Facts about two scenes of one place, of which a held button shows the other one.
#include "tests/app/view/view_acts.h"

SUITE(view_compare) {

// Both from one place: alike enough for a wearer to compare them, and unlike enough for a test.
const std::string kFirst = "builtin:fence", kSecond = "builtin:slanted-wall";
const std::string kPlace = " --eye 0,0,-1 --look 0,0,3 --up 0,-1,0";

TEST_CASE_FIXTURE(AtWork, "while a button is held the other scene is seen from there, at once and whole") {
    // By then the lines in front of the eyes have gone. The head turns between the two times.
    Acts acts("rate 20\nsize 96 96\nframes from 140 to 220\n");
    acts.wait(7.2 - acts.now_s);
    acts.hold("right a", 0.4).wait(0.6).head("position 0.1 1.55 0.1 turn 20 5", 0.3).wait(0.1);
    acts.hold("left x", 0.4).wait(0.6);
    const std::string headset = " --load-first --hide-panel --hide-hands --axes view" + kPlace;
    const ViewRun run = runClean(work, acts, kFirst + " --compare " + kSecond + " --mode temporal" + headset);
    const ViewRun first = runClean(work, acts, kFirst + " --mode shared" + headset);
    const ViewRun second = runClean(work, acts, kSecond + " --mode shared" + headset);
    checkOrder(run, {"compares " + kFirst + " with " + kSecond, "hold X or A", "shows " + kSecond,
                     "shows " + kFirst, "shows " + kSecond, "shows " + kFirst});
    std::size_t cuts = 0, of_second = 0, frames = 0;
    bool was_second = false;
    for (std::size_t frame = run.pictureAt(7.0);
         frame < run.frames.size() && run.frames[frame].contains("picture"); ++frame) {
        CAPTURE(frame);
        const Image seen = run.eye(frame, kLeft);
        const double as_first = compare(seen, first.eye(frame, kLeft)).psnrDb();
        const double as_second = compare(seen, second.eye(frame, kLeft)).psnrDb();
        const bool is_second = as_second > as_first;
        const bool is_cut = std::exchange(was_second, is_second) != is_second;
        // Nothing between the two, and the picture after a cut is exact: others are made from the one before.
        const double least_db = is_cut ? 50.0 : 30.0;
        CHECK(std::max(as_first, as_second) > least_db);
        CHECK(std::min(as_first, as_second) < 25.0);
        const Image alone = (is_second ? second : first).eye(frame, kRight);
        CHECK(compare(run.eye(frame, kRight), alone).psnrDb() > least_db);
        cuts += is_cut;
        of_second += is_second;
        ++frames;
    }
    CHECK(cuts == 4);
    CHECK(of_second == 16);  // twice 0.4 s of 20 Hz
    CHECK(frames > 30);
}

TEST_CASE_FIXTURE(AtWork, "where two scenes do not fit together, a line says so, and the first one stays") {
    work.go("scene atelier --splats 20000 --out many.ply");
    const ViewRun run = runClean(
        work, "rate 45\nsize 64 64\nframes none\nat 0.4 exit\n",
        "many.ply --compare builtin:atelier --load-first --mode mono --hide-hands --memory-limit 24");
    CHECK(run.says(
        "many.ply and builtin:atelier do not fit into the device's memory together: the first one stays"));
    CHECK_FALSE(run.says("compares "));
    CHECK(run.layers(run.frames.size() / 2, "projection").size() == 1);
}

}  // SUITE(view_compare)
