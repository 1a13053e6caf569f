// A row of the table of options: a name, a help text, and a field of a struct with its type and range, from
// which reading, writing and the documents follow.
#pragma once

#include "app/options/options.h"
#include "engine/setup/values.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <type_traits>
#include <variant>

namespace binosplat {

// The commands that have an option. `methods` is a bench's [[methods]], whose keys are options, too.
enum CommandBit : unsigned {
    kRender = 1,
    kBench = 2,
    kView = 4,
    kInfo = 8,
    kConvert = 16,
    kStability = 32,
    kKernels = 64,
    kCompare = 128,
    kScene = 256,
    kMethods = 512,
};

// An option's value for reports; monostate if there is none.
using OptionValue = std::variant<std::monostate, bool, std::uint64_t, double, std::string, glm::dvec3>;

// One field of Owner: the reader of its text, its value, and its range in words.
template <typename Owner>
struct OptionField {
    std::function<void(const Setting&, Owner&)> read;  // throws Error (bad input)
    std::function<OptionValue(const Owner&)> value;
    std::string range;
    std::optional<double> least, most;      // of a number
    std::optional<double> slider_most;      // the end of a slider, before `most`: few want larger values
    std::vector<std::string_view> choices;  // if it is one of a few names
    bool is_file = false;                   // the name of a file or a folder
};

// The description of an option.
struct OptionText {
    const char* key;    // --key on the command line, key in a config
    const char* table;  // the config table for it, unless it is at the top; "": only on the command line
    unsigned commands;
    const char* value;  // placeholder, with the unit; "" for a flag, in brackets if optional
    const char* help;
    const char* standard = "";  // the default, if the field's own does not say it
    bool required = false;
    bool by_command = false;  // the default depends on the command

    [[nodiscard]] bool isFlag() const { return *value == '\0'; }
};

template <typename Owner>
struct OptionRow {
    OptionText text;
    OptionField<Owner> field;
};

namespace field {

template <typename Owner, typename Field>
Owner ownerOf(Field Owner::*);

// A field of a field: pointers to members from the outermost one on.
template <auto First, auto... Rest>
struct Path {
    using Owner = decltype(ownerOf(First));
    static auto& in(auto& owner) {
        if constexpr (sizeof...(Rest) == 0) {
            return owner.*First;
        } else {
            return Path<Rest...>::in(owner.*First);
        }
    }
};

template <typename Value>
OptionValue toValue(const Value& value) {
    if constexpr (std::is_same_v<Value, bool> || std::is_same_v<Value, glm::dvec3>) {
        return value;
    } else if constexpr (std::is_enum_v<Value>) {
        return {};  // named() has a word for it
    } else if constexpr (std::is_integral_v<Value>) {
        return static_cast<std::uint64_t>(value);
    } else if constexpr (std::is_floating_point_v<Value>) {
        return static_cast<double>(value);
    } else if constexpr (std::is_same_v<Value, glm::uvec2>) {
        return fmt::format("{}x{}", value.x, value.y);
    } else if constexpr (std::is_same_v<Value, glm::dvec4>) {
        return fmt::format("{},{},{},{}", value.x, value.y, value.z, value.w);
    } else if constexpr (std::is_convertible_v<Value, std::filesystem::path>) {
        const std::string text = std::filesystem::path(value).string();
        return text.empty() ? OptionValue{} : text;
    } else {
        return value ? toValue(*value) : OptionValue{};
    }
}

// To a field, or to one that may be absent.
template <typename Field>
void assign(Field& field, const auto& value) {
    field = static_cast<Field>(value);
}
template <typename Field>
void assign(std::optional<Field>& field, const auto& value) {
    field = static_cast<Field>(value);
}

// `parse` makes the field's value from a Setting.
template <auto... Members>
auto make(std::string range, auto parse) {
    using At = Path<Members...>;
    using Owner = typename At::Owner;
    OptionField<Owner> made;
    made.read = [parse](const Setting& setting, Owner& owner) { assign(At::in(owner), parse(setting)); };
    made.value = [](const Owner& owner) { return toValue(At::in(owner)); };
    made.range = std::move(range);
    return made;
}

template <auto... Members>
auto number(double least, double most) {
    auto made = make<Members...>(fmt::format("{} to {}", least, most),
                                 [=](const Setting& s) { return readNumber(s, least, most); });
    made.least = least;
    made.most = most;
    return made;
}

// From 0 to 1, also in per cent.
template <auto... Members>
auto share() {
    auto made = make<Members...>("0 to 1, or 0% to 100%", readShare);
    made.least = 0.0;
    made.most = 1.0;
    return made;
}

template <auto... Members>
auto count(std::uint64_t least, std::uint64_t most) {
    const bool unlimited = most >= std::numeric_limits<std::uint32_t>::max();
    auto made =
        make<Members...>(unlimited ? fmt::format("{} or more", least) : fmt::format("{} to {}", least, most),
                         [=](const Setting& s) { return readCount(s, least, most); });
    made.least = static_cast<double>(least);
    made.most = static_cast<double>(most);
    return made;
}

template <auto... Members>
auto flag() {
    return make<Members...>("", readFlag);
}

template <auto... Members>
auto text() {
    return make<Members...>("", readText);
}

// With units, see amounts.h; its default is in the row's text.
template <auto... Members>
auto amount(auto parse) {
    using At = Path<Members...>;
    using Owner = typename At::Owner;
    OptionField<Owner> made;
    made.read = [parse](const Setting& setting, Owner& owner) { At::in(owner) = parse(setting); };
    made.value = [](const Owner&) { return OptionValue(); };
    return made;
}

// The name of a file or a folder.
template <auto... Members>
auto file(std::string (*parse)(const Setting&) = readText) {
    auto made = make<Members...>("", parse);
    made.is_file = true;
    return made;
}

// An enum, which may be absent, or a bool, by the names of its values from 0.
template <auto... Members>
auto named(std::vector<std::string_view> names) {
    using At = Path<Members...>;
    auto made = make<Members...>(fmt::format("{}", fmt::join(names, ", ")), [names](const Setting& s) {
        return std::ranges::find(names, readChoice(s, names)) - names.begin();
    });
    made.value = [names](const typename At::Owner& owner) {
        const std::optional value = At::in(owner);
        return value ? OptionValue(std::string(names[static_cast<std::size_t>(*value)])) : OptionValue();
    };
    made.choices = std::move(names);
    return made;
}

}  // namespace field

}  // namespace binosplat
