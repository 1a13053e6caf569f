// Facts about requests to the operating system, and about links, pipes and long files of someone else's.
#include "engine/part_file.h"
#include "engine/picture/image_io.h"
#include "engine/setup/camera_file.h"
#include "engine/setup/data_folders.h"
#include "engine/setup/head_motion.h"
#include "engine/setup/headset.h"
#include "engine/setup/output_files.h"
#include "engine/setup/settings.h"
#include "engine/setup/text_file.h"
#include "tests/hostile.h"
#include "tests/run_program.h"

#include <sys/stat.h>

#include <cerrno>

SUITE(platform) {

void makePipe(const fs::path& path) { REQUIRE(::mkfifo(path.c_str(), 0600) == 0); }

// Waiting for a pipe that nobody writes to would never end; SIGALRM ends the test instead.
struct Patience {
    Patience() { ::alarm(60); }
    ~Patience() { ::alarm(0); }
};

TEST_CASE("a thread's work counts, and not that of others") {
    const double before = threadSeconds();
    while (threadSeconds() < before + 0.02) {}
    double of_another = 1e9;
    std::thread([&] { of_another = threadSeconds(); }).join();
    CHECK(of_another < threadSeconds());
}

TEST_CASE_FIXTURE(AtWork, "a file or a folder is made only where nothing is, and no link is followed") {
    const fs::path victim = work.path / "victim", file = work.path / "file";
    work.write("victim", "keep me");
    fs::create_symlink(victim, work.path / "link");
    fs::create_symlink(work.path / "nowhere", work.path / "dangling");
    makePipe(work.path / "pipe");
    for (const char* taken : {"victim", "link", "dangling", "pipe"}) {
        errno = 0;
        CHECK_MESSAGE(createFile(work.path / taken) == nullptr, taken);
        CHECK(errno == EEXIST);
    }
    CHECK(work.bytesOf("victim") == "keep me");
    CHECK_FALSE(fs::exists(work.path / "nowhere"));
    const File made = createFile(file);
    REQUIRE(made != nullptr);
    CHECK(fs::is_regular_file(file));
    CHECK_FALSE(isTerminal(made.get()));
    errno = 0;
    CHECK(createFile(work.path / "no" / "folder") == nullptr);
    CHECK(errno == ENOENT);
    // Nobody else may enter the folders that are made.
    const fs::path one = createFolder(work.path, "mine-"), other = createFolder(work.path, "mine-");
    CHECK(one != other);
    for (const fs::path& folder : {one, other}) {
        CHECK(folder.parent_path() == work.path);
        CHECK(folder.filename().string().starts_with("mine-"));
        CHECK(fs::is_directory(folder));
        CHECK((fs::status(folder).permissions() & fs::perms::all) == fs::perms::owner_all);
    }
    CHECK(createFolder(work.path / "nowhere", "mine-").empty());
}

TEST_CASE_FIXTURE(AtWork, "a scene that is written goes through no link that waits for its unfinished file") {
    const fs::path victim = work.path / "victim", target = work.path / "scene.ply";
    work.write("victim", "keep me");
    const auto planted = [&](const std::string& attempt) {
        return fmt::format("scene.ply.part{}{}", processId(), attempt);
    };
    fs::create_symlink(victim, work.path / planted(""));
    fs::create_symlink(victim, work.path / planted("-0"));
    work.write(planted("-1"), "somebody's");
    for (const bool is_given_up : {false, true}) {
        {
            PartFile file(target.string());
            file.write(is_given_up ? "no" : "new", is_given_up ? 2 : 3);
            if (!is_given_up) { file.commit(); }
        }
        CHECK(these(work.bytesOf("scene.ply"), work.bytesOf("victim"), work.bytesOf(planted("-1"))) ==
              these("new", "keep me", "somebody's"));
    }
    CHECK(std::distance(fs::directory_iterator(work.path), {}) == 5);
}

TEST_CASE_FIXTURE(AtWork, "files that appear together do not replace a pipe, a device or a folder") {
    makePipe(work.path / "report");
    OutputFiles files(work.path);
    writeText(files.staging() / "another", "1");
    writeText(files.staging() / "report", "1");
    CHECK_THROWS_WITH_AS(
        files.publish(),
        doctest::Contains("report: cannot be written (not a regular file), must be a file or not there"),
        Error);
    CHECK(fs::is_fifo(work.path / "report"));
    CHECK_FALSE(fs::exists(work.path / "another"));
    fs::remove(work.path / "report");
    // A link is replaced; what it points to stays.
    work.write("victim", "keep me");
    fs::create_symlink(work.path / "victim", work.path / "report");
    files.publish();
    CHECK_FALSE(fs::is_symlink(work.path / "report"));
    CHECK(work.bytesOf("victim") == "keep me");
}

TEST_CASE("only files of a size that people write are read, anything else is refused at once") {
    const Patience patience;
    const Workplace work;
    makePipe(work.path / "pipe");
    fs::create_directory(work.path / "folder");
    fs::create_symlink("/dev/zero", work.path / "device");
    work.write("long", "");
    fs::resize_file(work.path / "long", std::uintmax_t{100} << 20);
    using Reader = void (*)(const fs::path&);
    for (const auto& [read, most] :
         {std::pair<Reader, int>([](const fs::path& path) { (void)readSettingsFile(path); }, 4),
          {[](const fs::path& path) { (void)readHeadset(path); }, 4},
          {[](const fs::path& path) { (void)readCameraFile(path, glm::dvec3(0.0)); }, 16},
          {[](const fs::path& path) { (void)readHeadMotion(path, MotionAxes::kOpenXr); }, 16}}) {
        for (const auto& [name, reason] : {std::pair<const char*, std::string>("pipe", "not a regular file"),
                                           {"device", "not a regular file"},
                                           {"folder", "is a directory"},
                                           {"long/below", "Not a directory"},
                                           {"long", fmt::format("longer than {} MiB", most)},
                                           {"none", "No such file or directory"}}) {
            const fs::path path = work.path / name;
            CHECK(test::errorOf([&] {
                      read(path);
                  }).starts_with(fmt::format("{}: cannot be read ({}), must be a", path.string(), reason)));
        }
    }
    CHECK(peakMebibytes() < 256);
    for (const char* name : {"pipe.png", "pipe.pfm", "pipe.ppm"}) {
        const fs::path path = work.path / name;
        makePipe(path);
        CHECK(test::errorOf([&] { (void)readPicture(path); }) ==
              path.string() + ": cannot be read (not a regular file), must be an image file");
    }
    // The largest allowed size is read, one byte more is too much.
    const fs::path path = work.path / "text";
    for (const std::size_t size : {std::size_t{0}, kMostTextBytes, kMostTextBytes + 1}) {
        work.write("text", std::string(size, 'a'));
        CHECK(readTextFile(path, "a text", kMostRecordingBytes).size() == size);
        if (size <= kMostTextBytes) { CHECK(readTextFile(path, "a text").size() == size); }
    }
    CHECK(test::errorOf([&] { (void)readTextFile(path, "a text"); }) ==
          path.string() + ": cannot be read (longer than 4 MiB), must be a text");
}

TEST_CASE_FIXTURE(AtWork, "a program runs with what it prints in a new file") {
    CHECK(runProgram({"sh", "-c", "echo out; echo error >&2; cat"}, work.path / "log"));
    CHECK(work.bytesOf("log") == "out\nerror\n");
    CHECK_FALSE(runProgram({"sh", "-c", "exit 3"}, work.path / "other"));
    work.write("victim", "keep me");
    fs::create_symlink(work.path / "victim", work.path / "link");
    CHECK_THROWS_WITH_AS(runProgram({"sh", "-c", "echo no"}, work.path / "link"),
                         doctest::Contains("sh cannot be run ("), Error);
    CHECK(work.bytesOf("victim") == "keep me");
    CHECK_THROWS_WITH_AS(runProgram({"no-such-program-anywhere"}, work.path / "third"),
                         "no-such-program-anywhere cannot be run (No such file or directory)", Error);
    CHECK_FALSE(runProgram({"sleep", "600"}, work.path / "ended", [] { return true; }));
    CHECK(these(functionOf("libc.so.6", "getpid") == nullptr, functionOf("libc.so.6", "no-such") == nullptr,
                functionOf("libno-such.so", "getpid") == nullptr) == these(false, true, true));
}

TEST_CASE("the environment is set and read, and the program knows its own file") {
    constexpr const char* kName = "BINOSPLAT_TEST_OF_ENVIRONMENT";
    CHECK(environment(kName).empty());
    setEnvironment(kName, "\u00e4 b");
    CHECK(environment(kName) == "\u00e4 b");
    setEnvironment(kName, "");
    CHECK(environment(kName).empty());
    CHECK(fs::equivalent(programFile(), "/proc/self/exe"));
}

TEST_CASE("the user's folders are where the environment says, and relative ones are nobody's") {
    const auto foldersWith = [](const char* home, const char* cache, const char* config) {
        for (const auto& [name, value] :
             {std::pair("HOME", home), {"XDG_CACHE_HOME", cache}, {"XDG_CONFIG_HOME", config}}) {
            setEnvironment(name, value);
        }
        CHECK(userHomeFolder() == (*home == '/' ? fs::path(home) : fs::path()));
        return std::pair(userCacheFolder(), userConfigFolder());
    };
    const std::string home = environment("HOME"), cache = environment("XDG_CACHE_HOME"),
                      config = environment("XDG_CONFIG_HOME");
    using Folders = std::pair<fs::path, fs::path>;
    CHECK(foldersWith("/home/somebody", "", "here") ==
          Folders("/home/somebody/.cache", "/home/somebody/.config"));
    CHECK(these(foldersWith("/home/somebody", "/caches", "/settings"), foldersWith("", "", ""),
                foldersWith("here", "", "")) == these(Folders("/caches", "/settings"), Folders(), Folders()));
    CHECK(fileSystemRoots() == std::vector<fs::path>{"/"});
    foldersWith(home.c_str(), cache.c_str(), config.c_str());
}

TEST_CASE_FIXTURE(AtWork, "the pictures' folder is the one that the desktop names, or Pictures at home") {
    const std::string home = environment("HOME"), config = environment("XDG_CONFIG_HOME");
    const auto folderWith = [&](const char* at_home, const std::string& place) {
        setEnvironment("HOME", at_home);
        work.write("user-dirs.dirs",
                   "# a comment\nXDG_MUSIC_DIR=\"$HOME/Lieder\"\nXDG_PICTURES_DIR=" + place + "\n");
        return userPicturesFolder();
    };
    setEnvironment("XDG_CONFIG_HOME", work.path.string());
    CHECK(folderWith("/me", "\"$HOME/Bilder und mehr\"") == "/me/Bilder und mehr");
    CHECK(folderWith("/me", "\"/photos\"") == "/photos");
    for (const char* wrong : {"\"photos\"", "\""}) { CHECK(folderWith("/me", wrong) == "/me/Pictures"); }
    CHECK(folderWith("", "\"$HOME/Bilder\"") == "");
    setEnvironment("HOME", home);
    setEnvironment("XDG_CONFIG_HOME", config);
}

}  // SUITE(platform)
