// Arrays to the device and back, and the verdict of the validation layers.
#include "tests/engine/gpu/gpu_fixture.h"

namespace binosplat::test {

const Context& Gpu::shared() {
    static const Context context({.device = {}, .validation = kValidation, .max_allocation_bytes = 0});
    return context;
}

Gpu::Gpu()
    : context_(shared()), commands_(context_), messages_before_(context_.validationMessages().size()) {}

Gpu::~Gpu() {
    CHECK(context_.validates() == kValidation);
    const std::vector<std::string> messages = context_.validationMessages();
    for (std::size_t i = messages_before_; i < messages.size(); ++i) {
        FAIL_CHECK("validation: " << messages[i]);
    }
}

const Kernel& Gpu::kernel(const std::string& shader, std::uint32_t push_bytes,
                          const std::vector<std::uint32_t>& constants) {
    // Made after the device, and destroyed before it.
    static std::map<std::pair<std::string, std::vector<std::uint32_t>>, Kernel> made;
    std::pair variant(shader, constants);
    const auto found = made.find(variant);
    if (found != made.end()) { return found->second; }
    return made.emplace(std::move(variant), Kernel(context_, shader, push_bytes, constants)).first->second;
}

void Gpu::write(const Buffer& buffer, std::span<const std::byte> bytes) {
    if (bytes.empty()) { return; }
    REQUIRE(bytes.size() <= buffer.bytes());
    const Buffer staging(context_, "upload", bytes.size(), MemoryKind::kUpload);
    std::memcpy(staging.mapped<std::byte>().data(), bytes.data(), bytes.size());
    run([&](Commands& commands) { commands.copy(staging, buffer, bytes.size()); });
}

void Gpu::read(const Buffer& buffer, std::span<std::byte> bytes, std::uint64_t offset_bytes) {
    if (bytes.empty()) { return; }
    REQUIRE(offset_bytes + bytes.size() <= buffer.bytes());
    const Buffer staging(context_, "read-back", bytes.size(), MemoryKind::kReadback);
    run([&](Commands& commands) { commands.copy(buffer, staging, bytes.size(), offset_bytes); });
    std::memcpy(bytes.data(), staging.mapped<std::byte>().data(), bytes.size());
}

gpu::ListState makeList(std::uint32_t needed, std::uint32_t capacity) {
    const std::uint32_t count = needed <= capacity ? needed : 0;
    const auto over = [&](std::uint64_t group_items) {
        const auto groups = static_cast<std::uint32_t>((count + group_items - 1) / group_items);
        const vk::Extent2D rows = groups > 0 ? Commands::rowsOf(groups) : vk::Extent2D(0, 0);
        return gpu::DispatchSize{rows.width, rows.height, 1};
    };
    constexpr std::uint64_t kMostAtOnce = std::uint64_t{gpu::kSortBlock} * gpu::kMaxSortBlocks;
    const std::uint64_t rounds = std::max<std::uint64_t>(1, (count + kMostAtOnce - 1) / kMostAtOnce);
    return {
        needed, count, 0, {}, over(gpu::kGroupSize), over(gpu::kListBlock), over(gpu::kSortBlock * rounds)};
}

}  // namespace binosplat::test
