// A small HTTP server on the loopback address that behaves as well or as badly as a test wants.
#pragma once

#include "tests/suite.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <list>
#include <mutex>

namespace binosplat::test {

struct WebRequest {
    std::string path;                            // with everything after a question mark
    std::map<std::string, std::string> headers;  // by name, in lower case
    std::size_t number = 0;                      // number of requests before it

    // Empty if there is no header with that name.
    [[nodiscard]] std::string header(const std::string& name) const {
        return headers.contains(name) ? headers.at(name) : "";
    }
};

// A server's answer to one request: `bytes` are sent as they are; then the connection stays open, is closed,
// or waits until the client closes it.
struct WebAnswer {
    std::string bytes;
    enum class Then { kGoOn, kClose, kHang } then = Then::kGoOn;
};

inline WebAnswer answer(const std::string& status, const std::string& headers = "",
                        const std::string& body = "") {
    return {fmt::format("HTTP/1.1 {}\r\nContent-Length: {}\r\n{}\r\n{}", status, body.size(), headers, body)};
}

// A server with these files, by path such as "/a/b.ply"; no others exist.
using WebPages = std::map<std::string, std::string>;
inline WebAnswer answerFrom(const WebPages& files, const WebRequest& request) {
    return files.contains(request.path) ? answer("200 OK", "", files.at(request.path))
                                        : answer("404 Not Found", "", "no such page");
}

class WebServer {
public:
    using Handler = std::function<WebAnswer(const WebRequest&)>;

    // Each connection has a thread of its own, which calls `handle`.
    explicit WebServer(Handler handle)
        : handle_(std::move(handle)), listener_(::socket(AF_INET, SOCK_STREAM, 0)) {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socklen_t length = sizeof(address);
        const bool listens = ::bind(listener_, reinterpret_cast<const sockaddr*>(&address), length) == 0 &&
                             ::listen(listener_, 64) == 0 &&
                             ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &length) == 0;
        check(listens, "a test's server cannot listen on the loopback address");
        port_ = ntohs(address.sin_port);
        acceptor_ = std::thread([this] { acceptAll(); });
    }
    explicit WebServer(WebPages files)
        : WebServer(
              [held = std::move(files)](const WebRequest& request) { return answerFrom(held, request); }) {}
    WebServer(const WebServer&) = delete;
    WebServer& operator=(const WebServer&) = delete;
    ~WebServer() { stop(); }

    [[nodiscard]] std::string at(const std::string& path) const {
        return fmt::format("http://127.0.0.1:{}{}", port_, path);
    }
    // The requested paths, in order.
    [[nodiscard]] std::vector<std::string> asked() const {
        const std::lock_guard lock(mutex_);
        return asked_;
    }
    [[nodiscard]] std::size_t connectionCount() const {
        const std::lock_guard lock(mutex_);
        return connections_.size();
    }

    // From now on nothing listens there; requests in progress continue. Handlers may also call this.
    void refuse() { ::shutdown(listener_, SHUT_RDWR); }

    // Ends everything.
    void stop() {
        if (!std::exchange(listens_, false)) { return; }
        refuse();
        acceptor_.join();
        ::close(listener_);
        for (const Connection& connection : connections_) { ::shutdown(connection.socket, SHUT_RDWR); }
        for (Connection& connection : connections_) {
            connection.thread.join();
            ::close(connection.socket);
        }
    }

private:
    struct Connection {
        int socket;
        std::thread thread;
    };

    void acceptAll() {
        for (;;) {
            const int client = ::accept(listener_, nullptr, nullptr);
            if (client < 0) { return; }
            const std::lock_guard lock(mutex_);
            connections_.push_back({client, std::thread([this, client] { serve(client); })});
        }
    }

    void serve(int client) {
        std::string bytes;
        while (auto request = readRequest(client, bytes)) {
            {
                const std::lock_guard lock(mutex_);
                request->number = asked_.size();
                asked_.push_back(request->path);
            }
            const WebAnswer given = handle_(*request);
            for (std::size_t sent = 0; sent < given.bytes.size();) {
                const ssize_t got =
                    ::send(client, given.bytes.data() + sent, given.bytes.size() - sent, MSG_NOSIGNAL);
                if (got <= 0) { return; }
                sent += static_cast<std::size_t>(got);
            }
            if (given.then == WebAnswer::Then::kClose) { break; }
            if (given.then == WebAnswer::Then::kHang) {
                char nothing = 0;
                (void)::recv(client, &nothing, 1, 0);  // returns when the client or the test gives up
                break;
            }
        }
        ::shutdown(client, SHUT_RDWR);
    }

    static std::optional<WebRequest> readRequest(int client, std::string& bytes) {
        std::size_t end = 0;
        while ((end = bytes.find("\r\n\r\n")) == std::string::npos) {
            char block[4096];
            const ssize_t got = ::recv(client, block, sizeof(block), 0);
            if (got <= 0) { return std::nullopt; }
            bytes.append(block, static_cast<std::size_t>(got));
        }
        std::istringstream head(bytes.substr(0, end + 2));
        bytes.erase(0, end + 4);
        WebRequest request;
        std::string line, method;
        head >> method >> request.path;
        std::getline(head, line);
        while (std::getline(head, line)) {
            const std::size_t colon = line.find(": ");
            if (colon == std::string::npos) { continue; }
            std::string name = line.substr(0, colon);
            for (char& letter : name) { letter = static_cast<char>(std::tolower(letter)); }
            request.headers[name] = line.substr(colon + 2, line.find('\r') - colon - 2);
        }
        return request;
    }

    Handler handle_;
    int listener_, port_ = 0;
    bool listens_ = true;
    mutable std::mutex mutex_;
    std::vector<std::string> asked_;
    std::list<Connection> connections_;
    std::thread acceptor_;
};

}  // namespace binosplat::test
