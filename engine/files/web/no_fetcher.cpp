// In a build without libcurl.
#include "engine/error.h"
#include "engine/files/web/fetcher.h"

namespace binosplat {

class Fetcher::Thread {};

Fetcher::Fetcher(const WebCache&, const FetchSettings&) {
    fail(
        "scenes from http and https addresses cannot be opened: this build has no network; download the "
        "file, or build with libcurl");
}
Fetcher::~Fetcher() = default;
std::future<Fetched> Fetcher::request(FetchRequest) { return {}; }
double Fetcher::share() const { return 0.0; }

}  // namespace binosplat
