// What the SPIR-V of compiled shaders says about their structs, and how it uses specialization constants and
// structs of addresses.
#pragma once

#include "tests/suite.h"

namespace binosplat::test {

struct Field {
    std::string name;
    std::size_t offset, bytes;
    bool operator==(const Field&) const = default;
};

struct Layout {
    std::string name;
    std::size_t bytes;
    std::vector<Field> fields;
};

// Calls `use` with each instruction: (length << 16 | opcode), and operands. Before these are five words.
template <typename Word, typename Use>
void forEachInstruction(std::span<Word> words, const Use& use) {
    for (std::size_t at = 5; at < words.size(); at += words[at] >> 16) {
        use(words.subspan(at, words[at] >> 16));
    }
}

class CompiledShader {
public:
    explicit CompiledShader(std::span<const std::uint32_t> words) {
        forEachInstruction(words, [&](Words whole) { read(whole[0] & 0xffff, whole.subspan(1)); });
        // A value computed only from constants counts as read if something computed from it is read; each is
        // computed from earlier ones.
        for (auto made = made_of_.rbegin(); made != made_of_.rend(); ++made) {
            if (used_.contains(made->first)) { used_.insert(made->second.begin(), made->second.end()); }
        }
    }

    // The structs that are laid out in memory; `bytes` is the stride of arrays of them, or 0 if there is no
    // such array.
    [[nodiscard]] std::vector<Layout> layouts() const {
        std::vector<Layout> layouts;
        for (const auto& [id, offsets] : offsets_) {
            const auto stride = strides_.find(id);
            Layout layout{nameOf(id), stride != strides_.end() ? stride->second : 0, {}};
            for (const auto& [member, offset] : offsets) {
                layout.fields.push_back(
                    {member_names_.at(id).at(member), offset, bytesOf(structs_.at(id)[member])});
            }
            layouts.push_back(std::move(layout));
        }
        return layouts;
    }
    // The struct of the push constants.
    [[nodiscard]] std::string pushStruct() const {
        const auto push =
            std::ranges::find_if(structs_, [&](const auto& one) { return nameOf(one.first) == "Push"; });
        return push != structs_.end() ? nameOf(push->second[0]) : "";
    }

    // The names of the constants that the shader declares, by constant_id, and the constant_ids of those that
    // it reads.
    [[nodiscard]] std::map<std::uint32_t, std::string> declaredConstants() const {
        std::map<std::uint32_t, std::string> names;
        for (const auto& [id, constant] : constants_) {
            if (names_.contains(id)) { names[constant] = names_.at(id); }
        }
        // A constant that is only used as the group size has no name.
        for (const auto& [id, constant] : constants_) { names.emplace(constant, "local_size_x"); }
        return names;
    }
    [[nodiscard]] std::set<std::uint32_t> readConstants() const {
        std::set<std::uint32_t> ids;
        for (const auto& [id, constant] : constants_) {
            if (used_.contains(id)) { ids.insert(constant); }
        }
        return ids;
    }
    // Names of structs that hold addresses and are copied out of memory, kept in a variable, or passed to a
    // function.
    [[nodiscard]] std::string copiedAddresses() const {
        std::string names;
        for (const std::uint32_t type : result_types_) {
            const auto pointee = local_pointers_.find(type);
            const std::uint32_t value = pointee == local_pointers_.end() ? type : pointee->second;
            if (structs_.contains(value) && holdsAddress(value)) { names += " " + nameOf(value); }
        }
        return names;
    }

    // Addresses that are loaded as if they might not be aligned to eight bytes.
    [[nodiscard]] std::size_t looseAddresses() const {
        return static_cast<std::size_t>(std::ranges::count_if(
            loosely_loaded_, [&](std::uint32_t type) { return addresses_.contains(type); }));
    }

private:
    using Words = std::span<const std::uint32_t>;
    static constexpr std::uint32_t kName = 5, kMemberName = 6, kExtInst = 12, kTypeInt = 21, kTypeFloat = 22,
                                   kTypeVector = 23, kTypeArray = 28, kTypeRuntimeArray = 29,
                                   kTypeStruct = 30, kTypePointer = 32, kConstant = 43,
                                   kSpecConstantComposite = 51, kSpecConstantOp = 52, kFunction = 54,
                                   kLoad = 61, kStore = 62, kDecorate = 71, kMemberDecorate = 72,
                                   kVectorShuffle = 79, kCompositeExtract = 81, kCompositeInsert = 82,
                                   kLoopMerge = 246, kSelectionMerge = 247, kSwitch = 251;

    void read(std::uint32_t opcode, Words operands) {
        constexpr std::uint32_t kSpecId = 1, kArrayStride = 6, kBuiltIn = 11, kOffset = 35;  // decorations
        constexpr std::uint32_t kWorkgroupSize = 25, kFunctionStorage = 7, kPhysicalStorage = 5349;
        in_function_ = in_function_ || opcode == kFunction;
        if (in_function_) { return use(opcode, operands); }
        switch (opcode) {
            case kName:
                names_[operands[0]] = textOf(operands.subspan(1));
                break;
            case kMemberName:
                member_names_[operands[0]][operands[1]] = textOf(operands.subspan(2));
                break;
            case kDecorate:
                if (operands[1] == kSpecId) { constants_[operands[0]] = operands[2]; }
                if (operands[1] == kBuiltIn && operands[2] == kWorkgroupSize) { used_.insert(operands[0]); }
                if (operands[1] == kArrayStride) { array_strides_[operands[0]] = operands[2]; }
                break;
            case kMemberDecorate:
                if (operands[2] == kOffset) { offsets_[operands[0]][operands[1]] = operands[3]; }
                break;
            case kTypeInt:
            case kTypeFloat:
                bytes_[operands[0]] = operands[1] / 8;
                break;
            case kTypeVector:
                bytes_[operands[0]] = bytes_[operands[1]] * operands[2];
                break;
            case kConstant:
                numbers_[operands[1]] = operands[2];
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
                // An array within a struct; its stride shows that it is laid out.
                if (array_strides_.contains(operands[0])) {
                    bytes_[operands[0]] = array_strides_[operands[0]] * numbers_[operands[2]];
                }
                break;
            case kTypeRuntimeArray:
                elements_[operands[0]] = operands[1];
                strides_[operands[1]] = array_strides_[operands[0]];
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

    // Ends with a zero.
    static std::string textOf(Words words) { return reinterpret_cast<const char*>(words.data()); }

    // For an instruction in a function: its type, if it has a result, and the ids among its operands; some
    // operands are plain numbers.
    void use(std::uint32_t opcode, Words operands) {
        if (operands.empty()) { return; }
        result_types_.insert(operands[0]);
        // The mask of a load says Aligned, and the number of bytes.
        if (opcode == kLoad && operands.size() > 4 && (operands[3] & 2) != 0 && operands[4] < 8) {
            loosely_loaded_.push_back(operands[0]);
        }
        static const std::map<std::uint32_t, std::pair<std::size_t, std::size_t>> kIds{
            {kLoad, {0, 3}},          {kCompositeExtract, {0, 3}},
            {kVectorShuffle, {0, 4}}, {kCompositeInsert, {0, 4}},
            {kStore, {0, 2}},         {kSwitch, {0, 1}},
            {kLoopMerge, {0, 0}},     {kSelectionMerge, {0, 0}},
            {kExtInst, {4, SIZE_MAX}}};
        const auto ids = kIds.find(opcode);
        const auto [first, end] =
            ids != kIds.end() ? ids->second : std::pair(std::size_t{0}, operands.size());
        for (std::size_t i = first; i < std::min(end, operands.size()); ++i) { used_.insert(operands[i]); }
    }

    [[nodiscard]] std::string nameOf(std::uint32_t id) const {
        return names_.contains(id) ? names_.at(id) : "";
    }

    [[nodiscard]] bool holdsAddress(std::uint32_t type) const {
        if (addresses_.contains(type)) { return true; }
        if (const auto array = elements_.find(type); array != elements_.end()) {
            return holdsAddress(array->second);
        }
        const auto found = structs_.find(type);
        return found != structs_.end() &&
               std::ranges::any_of(found->second, [&](std::uint32_t member) { return holdsAddress(member); });
    }

    [[nodiscard]] std::size_t bytesOf(std::uint32_t type) const {
        if (const auto found = structs_.find(type); found != structs_.end()) {
            const auto last = static_cast<std::uint32_t>(found->second.size() - 1);
            return offsets_.at(type).at(last) + bytesOf(found->second[last]);
        }
        const auto found = bytes_.find(type);
        return found != bytes_.end() ? found->second : 8;  // a pointer
    }

    bool in_function_ = false;
    std::map<std::uint32_t, std::string> names_;
    std::map<std::uint32_t, std::map<std::uint32_t, std::string>> member_names_;
    std::map<std::uint32_t, std::map<std::uint32_t, std::uint32_t>> offsets_;
    std::map<std::uint32_t, std::uint32_t> numbers_;  // constants that nobody specializes
    std::map<std::uint32_t, std::size_t> bytes_, strides_, array_strides_;
    std::map<std::uint32_t, std::uint32_t> constants_, elements_, local_pointers_;
    std::map<std::uint32_t, std::vector<std::uint32_t>> structs_;
    std::vector<std::pair<std::uint32_t, std::vector<std::uint32_t>>> made_of_;
    std::vector<std::uint32_t> loosely_loaded_;
    std::set<std::uint32_t> used_, addresses_, result_types_;
};

}  // namespace binosplat::test
