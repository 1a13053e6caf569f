// The basis of GPU tests: a device under the validation layers, arrays to it and back, and lists as the
// shaders make them.
#pragma once

#include "engine/gpu/commands.h"
#include "tests/suite.h"

namespace binosplat::test {

// Whether programs can have the validation layers at all.
inline constexpr bool kValidation = BINOSPLAT_TEST_VALIDATION;

// A buffer's address, of whatever a field of a pass points to.
struct At {
    const Buffer& buffer;
    template <typename T>
    operator gpu::DeviceAddress<T>() const {
        return buffer.address<T>();
    }
};
inline At at(const Buffer& buffer) { return {buffer}; }

// Fixture for test cases. All tests of a program share one device. If there is none, every test fails. Any
// message of the validation layers during a test makes it fail, too.
class Gpu {
public:
    Gpu();
    Gpu(const Gpu&) = delete;
    Gpu& operator=(const Gpu&) = delete;
    ~Gpu();

    [[nodiscard]] const Context& context() const { return context_; }
    // Created by the first test that uses it; throws in every test if there is no device.
    [[nodiscard]] static const Context& shared();

    // A device buffer with these values; at least one value, so that it has an address.
    template <typename T>
    [[nodiscard]] Buffer upload(const std::string& name, const std::vector<T>& values) {
        Buffer buffer(context_, name, std::max<std::size_t>(values.size(), 1) * sizeof(T));
        write(buffer, std::as_bytes(std::span(values)));
        return buffer;
    }
    template <typename T>
    void upload(const Buffer& buffer, const std::vector<T>& values) {
        write(buffer, std::as_bytes(std::span(values)));
    }
    template <typename T>
    [[nodiscard]] Buffer allocate(const std::string& name, std::size_t count) {
        return Buffer(context_, name, std::max<std::size_t>(count, 1) * sizeof(T));
    }
    template <typename T>
    [[nodiscard]] std::vector<T> readBack(const Buffer& buffer, std::size_t count,
                                          std::uint64_t offset_bytes = 0) {
        std::vector<T> values(count);
        read(buffer, std::as_writable_bytes(std::span(values)), offset_bytes);
        return values;
    }

    // Made once for all tests of a program.
    template <typename K>
    [[nodiscard]] const Kernel& kernel(const K& variant) {
        return kernel(K::kShader, sizeof(typename K::Pass), valuesOf(variant));
    }
    [[nodiscard]] const Kernel& kernel(const std::string& shader, std::uint32_t push_bytes,
                                       const std::vector<std::uint32_t>& constants = {});

    // Runs what `record(commands)` records, and waits for it.
    template <typename Record>
    void run(const Record& record) {
        commands_.begin();
        record(commands_);
        commands_.submitAndWait();
    }
    // A kernel alone.
    void dispatch(const Kernel& kernel, const auto& pass, glm::uvec2 groups) {
        run([&](Commands& commands) { commands.dispatch(kernel, pass, groups.x, groups.y); });
    }
    void dispatchOver(const Kernel& kernel, const auto& pass, std::uint64_t items,
                      gpu::uint group_items = gpu::kGroupSize) {
        run([&](Commands& commands) { commands.dispatchOver(kernel, pass, items, group_items); });
    }
    void dispatchIndirect(const Kernel& kernel, const auto& pass, const Buffer& sizes,
                          std::uint64_t offset_bytes) {
        run([&](Commands& commands) { commands.dispatchIndirect(kernel, pass, sizes, offset_bytes); });
    }

private:
    void write(const Buffer& buffer, std::span<const std::byte> bytes);
    void read(const Buffer& buffer, std::span<std::byte> bytes, std::uint64_t offset_bytes);

    const Context& context_;
    Commands commands_;
    std::size_t messages_before_;
};

inline std::vector<std::uint32_t> numbersUpTo(std::size_t end) {
    std::vector<std::uint32_t> numbers(end);
    std::iota(numbers.begin(), numbers.end(), 0u);
    return numbers;
}

// A list of `needed` items with capacity `capacity`, as shaders/lib/list.glsl makes it.
gpu::ListState makeList(std::uint32_t needed, std::uint32_t capacity);
inline gpu::ListState makeList(std::size_t count) {
    return makeList(static_cast<std::uint32_t>(count), UINT32_MAX);
}

}  // namespace binosplat::test
