// Checks of the simulated runtime's results, in tables: for changes made one at a time, for missing
// arguments, and for calls that list.
#pragma once

#include "tests/suite.h"

#include <openxr/openxr.h>

namespace doctest {
template <>
struct StringMaker<XrResult> {
    static String convert(XrResult result) { return doctest::toString(static_cast<int>(result)); }
};
}  // namespace doctest

namespace binosplat::test {

// Checks the results of several calls.
inline void checkEach(XrResult expected, std::initializer_list<XrResult> answers) {
    int number = 0;
    for (const XrResult answer : answers) {
        ++number;
        CAPTURE(number);
        CHECK(answer == expected);
    }
}

// The result of a call while a variable has another value.
template <class Value, class Call>
auto with(Value& place, std::type_identity_t<Value> value, const Call& call) {
    const Value before = std::exchange(place, value);
    const auto answer = call();
    place = before;
    return answer;
}

// A change for checkChanges.
template <class Value>
auto to(Value& place, std::type_identity_t<Value> value) {
    return [&place, value](const auto& call) { return with(place, value, call); };
}
// Checks the results of a call with changes made one at a time.
template <class Call, class... Change>
void checkChanges(const Call& call, XrResult expected, const Change&... changes) {
    int number = 0;
    const auto check = [&](const auto& change) {
        ++number;
        CAPTURE(number);
        CHECK(change(call) == expected);
    };
    (check(changes), ...);
}

// Checks the results of a call with an invalid handle, and with each structure, or place for an answer,
// missing or of the wrong type.
template <class Function, class Handle, class... Places>
void checkArguments(Function call, Handle handle, Places*... places) {
    const auto answer = [&](Handle of, Places*... to) { return call(of, to...); };
    CHECK(answer(XR_NULL_HANDLE, places...) == XR_ERROR_HANDLE_INVALID);
    std::tuple<Places*...> all{places...};
    const auto checkOne = [&](auto& place) {
        const auto again = [&] {
            return std::apply([&](Places*... to) { return answer(handle, to...); }, all);
        };
        CHECK(with(place, nullptr, again) == XR_ERROR_VALIDATION_FAILURE);
        if constexpr (requires { place->type; }) {
            CHECK(with(place->type, XR_TYPE_UNKNOWN, again) == XR_ERROR_VALIDATION_FAILURE);
        }
    };
    std::apply([&](auto&... place) { (checkOne(place), ...); }, all);
}

// Everything that a function lists in two calls; also checks its results for too little capacity and for
// missing places.
template <class Value, class List>
std::vector<Value> checkList(const List& list, const Value& blank = {}) {
    std::uint32_t count = 0;
    CHECK(list(0u, &count, static_cast<Value*>(nullptr)) == XR_SUCCESS);
    REQUIRE(count > 0);
    std::vector<Value> values(count, blank);
    CHECK(list(count, &count, static_cast<Value*>(nullptr)) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(list(count, static_cast<std::uint32_t*>(nullptr), values.data()) == XR_ERROR_VALIDATION_FAILURE);
    if (count > 1) { CHECK(list(count - 1, &count, values.data()) == XR_ERROR_SIZE_INSUFFICIENT); }
    CHECK(count == values.size());
    CHECK(list(count, &count, values.data()) == XR_SUCCESS);
    if constexpr (requires { values[0].type; }) {
        CHECK(with(values.back().type, XR_TYPE_UNKNOWN, [&] { return list(count, &count, values.data()); }) ==
              XR_ERROR_VALIDATION_FAILURE);
    }
    return values;
}

// The same of a function that lists what belongs to a handle; checks an invalid handle, too.
template <class Value, class Function, class Handle, class... Rest>
std::vector<Value> checkListOf(const Value& blank, Function call, Handle handle, Rest... rest) {
    std::uint32_t count = 0;
    CHECK(call(XR_NULL_HANDLE, rest..., 0, &count, nullptr) == XR_ERROR_HANDLE_INVALID);
    return checkList<Value>([&](auto... step) { return call(handle, rest..., step...); }, blank);
}

inline void checkNear(const XrVector3f& found, const XrVector3f& expected) {
    CHECK(these(found.x, found.y, found.z) ==
          these(doctest::Approx(expected.x), doctest::Approx(expected.y), doctest::Approx(expected.z)));
}

}  // namespace binosplat::test
