// What compiled shaders do with specialization constants and with structs of addresses, read from their SPIR-V.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace binosplat::test {

class ShaderWords {
public:
    explicit ShaderWords(std::span<const std::uint32_t> words) {
        // Five words of header, then instructions of (length << 16 | opcode) and operands.
        for (std::size_t at = 5; at < words.size(); at += words[at] >> 16) {
            read(words[at] & 0xffff, words.subspan(at + 1, (words[at] >> 16) - 1));
        }
        // What is made of constants alone is read if what is made of it is; the later ones are made of the earlier.
        for (auto made = made_of_.rbegin(); made != made_of_.rend(); ++made) {
            if (used_.contains(made->first)) { used_.insert(made->second.begin(), made->second.end()); }
        }
    }

    // The names of what the shader declares, by constant_id, and the constant_id of what it reads.
    [[nodiscard]] std::map<std::uint32_t, std::string> declaredConstants() const {
        std::map<std::uint32_t, std::string> names;
        for (const auto& [id, constant] : constants_) {
            if (names_.contains(id)) { names[constant] = names_.at(id); }
        }
        for (const auto& [id, constant] : constants_) {
            names.emplace(constant, "local_size_x");
        }  // where it is nothing else, it has no name
        return names;
    }
    [[nodiscard]] std::set<std::uint32_t> readConstants() const {
        std::set<std::uint32_t> ids;
        for (const auto& [id, constant] : constants_) {
            if (used_.contains(id)) { ids.insert(constant); }
        }
        return ids;
    }
    // Structs that hold addresses and are copied out of memory, kept in a variable, or given to a function, by name.
    [[nodiscard]] std::string copiedAddresses() const {
        std::string names;
        for (const std::uint32_t type : result_types_) {
            const auto pointee = local_pointers_.find(type);
            const std::uint32_t value = pointee == local_pointers_.end() ? type : pointee->second;
            if (structs_.contains(value) && holdsAddress(value)) { names += " " + names_.at(value); }
        }
        return names;
    }

    // Addresses that are loaded out of memory as if they might lie elsewhere than at a multiple of eight bytes.
    [[nodiscard]] std::size_t looseAddresses() const {
        return static_cast<std::size_t>(
            std::ranges::count_if(loosely_loaded_, [&](std::uint32_t type) { return addresses_.contains(type); }));
    }

private:
    using Words = std::span<const std::uint32_t>;
    enum Opcode : std::uint32_t {
        kName = 5,
        kExtInst = 12,
        kTypeArray = 28,
        kTypeRuntimeArray = 29,
        kTypeStruct = 30,
        kTypePointer = 32,
        kSpecConstantComposite = 51,
        kSpecConstantOp = 52,
        kFunction = 54,
        kLoad = 61,
        kStore = 62,
        kDecorate = 71,
        kVectorShuffle = 79,
        kCompositeExtract = 81,
        kCompositeInsert = 82,
        kLoopMerge = 246,
        kSelectionMerge = 247,
        kSwitch = 251
    };

    void read(std::uint32_t opcode, Words operands) {
        constexpr std::uint32_t kSpecId = 1, kBuiltIn = 11, kWorkgroupSize = 25, kFunctionStorage = 7, kPhysicalStorage = 5349;
        in_function_ = in_function_ || opcode == kFunction;
        if (in_function_) { return use(opcode, operands); }
        switch (opcode) {
            case kName:
                for (const std::uint32_t word : operands.subspan(1)) {
                    for (int byte = 0; byte < 4 && (word >> 8 * byte & 0xff) != 0; ++byte) {
                        names_[operands[0]] += static_cast<char>(word >> 8 * byte & 0xff);
                    }
                }
                break;
            case kDecorate:
                if (operands[1] == kSpecId) { constants_[operands[0]] = operands[2]; }
                if (operands[1] == kBuiltIn && operands[2] == kWorkgroupSize) { used_.insert(operands[0]); }
                break;
            case kSpecConstantComposite:
                made_of_.emplace_back(operands[1], std::vector(operands.begin() + 2, operands.end()));
                break;
            case kSpecConstantOp:
                made_of_.emplace_back(operands[1], std::vector(operands.begin() + 3, operands.end()));
                break;
            case kTypeArray:
                used_.insert(operands[2]);
                elements_[operands[0]] = operands[1];
                break;
            case kTypeRuntimeArray:
                elements_[operands[0]] = operands[1];
                break;
            case kTypeStruct:
                structs_[operands[0]].assign(operands.begin() + 1, operands.end());
                break;
            case kTypePointer:
                if (operands[1] == kPhysicalStorage) { addresses_.insert(operands[0]); }
                if (operands[1] == kFunctionStorage) { local_pointers_[operands[0]] = operands[2]; }
                break;
            default:
                break;
        }
    }

    // Of an instruction in a function: its type, if it has a result, and the ids among its operands; some of them are plain numbers.
    void use(std::uint32_t opcode, Words operands) {
        if (operands.empty()) { return; }
        result_types_.insert(operands[0]);
        std::size_t first = 0, end = operands.size();
        switch (opcode) {
            case kLoad:
                // A mask that says Aligned, and to how many bytes.
                if (operands.size() > 4 && (operands[3] & 2) != 0 && operands[4] < 8) { loosely_loaded_.push_back(operands[0]); }
                end = 3;
                break;
            case kCompositeExtract:
                end = 3;
                break;
            case kVectorShuffle:
            case kCompositeInsert:
                end = 4;
                break;
            case kStore:
                end = 2;
                break;
            case kSwitch:
                end = 1;
                break;
            case kLoopMerge:
            case kSelectionMerge:
                end = 0;
                break;
            case kExtInst:
                first = 4;
                break;
            default:
                break;
        }
        for (std::size_t i = first; i < end; ++i) { used_.insert(operands[i]); }
    }

    [[nodiscard]] bool holdsAddress(std::uint32_t type) const {
        if (addresses_.contains(type)) { return true; }
        if (const auto array = elements_.find(type); array != elements_.end()) { return holdsAddress(array->second); }
        const auto found = structs_.find(type);
        return found != structs_.end() && std::ranges::any_of(found->second, [&](std::uint32_t member) { return holdsAddress(member); });
    }

    bool in_function_ = false;
    std::map<std::uint32_t, std::string> names_;
    std::map<std::uint32_t, std::uint32_t> constants_, elements_, local_pointers_;
    std::map<std::uint32_t, std::vector<std::uint32_t>> structs_;
    std::vector<std::pair<std::uint32_t, std::vector<std::uint32_t>>> made_of_;
    std::vector<std::uint32_t> loosely_loaded_;
    std::set<std::uint32_t> used_, addresses_, result_types_;
};

}  // namespace binosplat::test
