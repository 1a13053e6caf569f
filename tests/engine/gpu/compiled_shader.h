// What the SPIR-V of compiled shaders says about their structs, and how it uses specialization constants and
// structs of addresses.
#pragma once

#include "engine/gpu/context.h"
#include "shaders/embedded_shaders.h"
#include "tests/suite.h"

namespace binosplat::test {

struct Layout {
    std::string name;
    std::size_t bytes = 0;
    std::string fields = {}, names = {};  // field by field, where and how long it is, and its name

    void add(std::size_t offset, std::size_t field_bytes) {
        fields += fmt::format("{}+{} ", offset, field_bytes);
    }
};

// Calls `use` with each instruction: (length << 16 | opcode), and operands. Before these are five words.
template <typename Word, typename Use>
void forEachInstruction(std::span<Word> words, const Use& use) {
    for (std::size_t at = 5; at < words.size(); at += words[at] >> 16) {
        use(words.subspan(at, words[at] >> 16));
    }
}

// Kernels that are made from now on have this shader with each of its instructions changed by `change`.
template <typename Change>
void changeShader(const Context& context, const std::string& name, const Change& change) {
    const auto embedded = embeddedShader(name);
    std::vector<std::uint32_t>& words = context.replacedShaders()[name];
    words.assign(embedded.begin(), embedded.end());
    forEachInstruction(std::span(words), change);
}

class CompiledShader {
    using Words = std::span<const std::uint32_t>;

public:
    explicit CompiledShader(Words words) {
        std::map<std::uint32_t, std::vector<Words>> declared;  // by opcode
        bool in_function = false;
        forEachInstruction(words, [&](Words whole) {
            const std::uint32_t opcode = whole[0] & 0xffff;
            in_function = in_function || opcode == kFunction;
            const Words operands = whole.subspan(1);
            in_function ? use(opcode, operands) : declared[opcode].push_back(operands);
            if (opcode == kSpecConstantComposite) { made_of_.emplace_back(operands[1], operands.subspan(2)); }
            if (opcode == kSpecConstantOp) { made_of_.emplace_back(operands[1], operands.subspan(3)); }
        });
        readDecorations(declared);
        readTypes(declared);
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
            Layout& layout = layouts.emplace_back(Layout{nameOf(id)});
            if (strides_.contains(id)) { layout.bytes = strides_.at(id); }
            for (const auto& [member, offset] : offsets) {
                layout.add(offset, bytesOf(structs_.at(id)[member]));
                layout.names += member_names_.at(id).at(member) + " ";
            }
        }
        return layouts;
    }
    // The struct of the push constants.
    [[nodiscard]] std::string pushStruct() const {
        for (const auto& [id, members] : structs_) {
            if (nameOf(id) == "Push") { return nameOf(members[0]); }
        }
        return {};
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
        std::size_t loose = 0;
        for (const std::uint32_t type : loosely_loaded_) { loose += addresses_.contains(type); }
        return loose;
    }

private:
    static constexpr std::uint32_t kName = 5, kMemberName = 6, kExtInst = 12, kTypeInt = 21, kTypeFloat = 22,
                                   kTypeVector = 23, kTypeArray = 28, kTypeRuntimeArray = 29,
                                   kTypeStruct = 30, kTypePointer = 32, kConstant = 43,
                                   kSpecConstantComposite = 51, kSpecConstantOp = 52, kFunction = 54,
                                   kLoad = 61, kStore = 62, kDecorate = 71, kMemberDecorate = 72,
                                   kVectorShuffle = 79, kCompositeExtract = 81, kCompositeInsert = 82,
                                   kLoopMerge = 246, kSelectionMerge = 247, kSwitch = 251;

    void readDecorations(std::map<std::uint32_t, std::vector<Words>>& declared) {
        constexpr std::uint32_t kSpecId = 1, kArrayStride = 6, kBuiltIn = 11, kOffset = 35,
                                kWorkgroupSize = 25;
        for (const Words w : declared[kName]) { names_[w[0]] = textOf(w.subspan(1)); }
        for (const Words w : declared[kMemberName]) { member_names_[w[0]][w[1]] = textOf(w.subspan(2)); }
        for (const Words w : declared[kDecorate]) {
            if (w[1] == kSpecId) { constants_[w[0]] = w[2]; }
            if (w[1] == kBuiltIn && w[2] == kWorkgroupSize) { used_.insert(w[0]); }
            if (w[1] == kArrayStride) { array_strides_[w[0]] = w[2]; }
        }
        for (const Words w : declared[kMemberDecorate]) {
            if (w[2] == kOffset) { offsets_[w[0]][w[1]] = w[3]; }
        }
    }
    void readTypes(std::map<std::uint32_t, std::vector<Words>>& declared) {
        constexpr std::uint32_t kFunctionStorage = 7, kPhysicalStorage = 5349;
        for (const Words w : declared[kTypeInt]) { bytes_[w[0]] = w[1] / 8; }
        for (const Words w : declared[kTypeFloat]) { bytes_[w[0]] = w[1] / 8; }
        for (const Words w : declared[kTypeVector]) { bytes_[w[0]] = bytes_[w[1]] * w[2]; }
        for (const Words w : declared[kConstant]) { numbers_[w[1]] = w[2]; }
        for (const Words w : declared[kTypeArray]) {
            used_.insert(w[2]);
            elements_[w[0]] = w[1];
            // An array within a struct; its stride shows that it is laid out.
            if (array_strides_.contains(w[0])) { bytes_[w[0]] = array_strides_[w[0]] * numbers_[w[2]]; }
        }
        for (const Words w : declared[kTypeRuntimeArray]) {
            elements_[w[0]] = w[1];
            strides_[w[1]] = array_strides_[w[0]];
        }
        for (const Words w : declared[kTypeStruct]) { structs_[w[0]].assign(w.begin() + 1, w.end()); }
        for (const Words w : declared[kTypePointer]) {
            if (w[1] == kPhysicalStorage) { addresses_.insert(w[0]); }
            if (w[1] == kFunctionStorage) { local_pointers_[w[0]] = w[2]; }
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
        if (elements_.contains(type)) { return holdsAddress(elements_.at(type)); }
        const auto found = structs_.find(type);
        return found != structs_.end() &&
               std::ranges::any_of(found->second, [&](std::uint32_t member) { return holdsAddress(member); });
    }

    [[nodiscard]] std::size_t bytesOf(std::uint32_t type) const {
        if (const auto found = structs_.find(type); found != structs_.end()) {
            const auto last = static_cast<std::uint32_t>(found->second.size() - 1);
            return offsets_.at(type).at(last) + bytesOf(found->second[last]);
        }
        return bytes_.contains(type) ? bytes_.at(type) : 8;  // a pointer
    }

    std::map<std::uint32_t, std::string> names_;
    std::map<std::uint32_t, std::map<std::uint32_t, std::string>> member_names_;
    std::map<std::uint32_t, std::map<std::uint32_t, std::uint32_t>> offsets_;
    std::map<std::uint32_t, std::uint32_t> numbers_;  // constants that nobody specializes
    std::map<std::uint32_t, std::size_t> bytes_, strides_, array_strides_;
    std::map<std::uint32_t, std::uint32_t> constants_, elements_, local_pointers_;
    std::map<std::uint32_t, std::vector<std::uint32_t>> structs_;
    std::vector<std::pair<std::uint32_t, Words>> made_of_;
    std::vector<std::uint32_t> loosely_loaded_;
    std::set<std::uint32_t> used_, addresses_, result_types_;
};

}  // namespace binosplat::test
