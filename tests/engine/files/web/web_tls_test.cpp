// Someone else's server, over TLS: whose certificates are trusted, and how many connections a scene takes.
#include "tests/engine/files/sog_scenes.h"
#include "tests/engine/files/web/web_runs.h"
#include "tests/xr/simulated/installed.h"

#include <csignal>

SUITE(web_tls) {

// A program that runs alongside the test, for a minute at most.
class Beside {
public:
    Beside(const Folder& folder, const std::string& command)
        : told_(::popen(
              fmt::format("cd '{}' && echo $$ && exec timeout --foreground 60 {}", folder.file("."), command)
                  .c_str(),
              "r")) {
        REQUIRE(told_ != nullptr);
        pid_ = std::stoi(lineWith("").value());
    }
    Beside(const Beside&) = delete;
    Beside& operator=(const Beside&) = delete;
    ~Beside() {
        end();
        ::pclose(told_);
    }

    // The next line of its output that contains `part`; none once the output has ended.
    std::optional<std::string> lineWith(const std::string& part) {
        std::array<char, 1024> line{};
        while (std::fgets(line.data(), static_cast<int>(line.size()), told_) != nullptr) {
            if (contains(line.data(), part)) { return line.data(); }
        }
        return std::nullopt;
    }
    void end() const { ::kill(pid_, SIGTERM); }

private:
    std::FILE* told_;
    pid_t pid_ = 0;
};

// A port for another program to listen on, which was free a moment ago.
int freePort() {
    const std::string address = WebServer(WebPages()).at("");
    return std::stoi(address.substr(address.rfind(':') + 1));
}

TEST_CASE("a certificate must be valid; HTTP/2 sends all files of a scene over one connection") {
    if (!isInstalled("openssl", "openssl") || !isInstalled("nghttpd", "nghttp2-server")) { return; }
    const Folder folder;
    const std::string scene = writeSogFolder(folder, "sog", makeSog());
    // A certificate for the loopback address that nobody vouches for.
    const std::string make =
        "openssl req -x509 -newkey rsa:2048 -nodes -keyout key.pem -out own.pem -subj /CN=localhost "
        "-addext subjectAltName=DNS:localhost,IP:127.0.0.1 2> /dev/null";
    REQUIRE(std::system(fmt::format("cd '{}' && {}", folder.file("."), make).c_str()) == 0);
    const int port = freePort();
    const std::string address = fmt::format("https://127.0.0.1:{}/meta.json", port);
    Beside server(
        folder, fmt::format("nghttpd -v -a 127.0.0.1 -d '{}' {} key.pem own.pem 2> /dev/null", scene, port));
    REQUIRE(server.lineWith("listen 127.0.0.1"));
    CHECK(webError(address, webSettings(folder))
              .starts_with(address + ": the server's certificate is not valid ("));
    // When issued by an authority that the user trusts, it is accepted.
    setEnvironment("SSL_CERT_FILE", folder.file("own.pem"));
    checkSameScene(loadScene(scene), loadFromWeb(address, webSettings(folder)));
    setEnvironment("SSL_CERT_FILE", "");
    server.end();
    std::set<std::string> connections;
    std::size_t asked = 0;
    while (const auto line = server.lineWith(":path: ")) {
        ++asked;
        connections.insert(line->substr(0, line->find(']')));
    }
    CHECK(these(asked, connections.size()) == these(makeSog().size(), 1));
}

}  // SUITE(web_tls)
