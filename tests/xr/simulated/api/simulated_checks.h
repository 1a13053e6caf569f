// Answers of the simulated runtime, checked in tables: to changes made one at a time, to what is missing, in calls that list.
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

// What each of some calls answered.
inline void checkEach(XrResult expected, std::initializer_list<XrResult> answers) {
    int number = 0;
    for (const XrResult answer : answers) {
        ++number;
        CAPTURE(number);
        CHECK(answer == expected);
    }
}

// What a call answers while a value is another.
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
// What a call answers to each of some changes, made one at a time.
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

// What a call answers to a handle that is none, and to each structure, or place for an answer, that is missing or of another type.
template <class Function, class Handle, class... Places>
void checkArguments(Function call, Handle handle, Places*... places) {
    const auto answer = [&](Handle of, Places*... to) { return call(of, to...); };
    CHECK(answer(XR_NULL_HANDLE, places...) == XR_ERROR_HANDLE_INVALID);
    std::tuple<Places*...> all{places...};
    const auto checkOne = [&](auto& place) {
        const auto again = [&] { return std::apply([&](Places*... to) { return answer(handle, to...); }, all); };
        CHECK(with(place, nullptr, again) == XR_ERROR_VALIDATION_FAILURE);
        if constexpr (requires { place->type; }) { CHECK(with(place->type, XR_TYPE_UNKNOWN, again) == XR_ERROR_VALIDATION_FAILURE); }
    };
    std::apply([&](auto&... place) { (checkOne(place), ...); }, all);
}

// All that a function lists in two calls, and what it says of too little room and of places that are missing.
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
        CHECK(with(values.back().type, XR_TYPE_UNKNOWN, [&] { return list(count, &count, values.data()); }) == XR_ERROR_VALIDATION_FAILURE);
    }
    return values;
}

inline void checkNear(const XrVector3f& found, const XrVector3f& expected) {
    CHECK(these(found.x, found.y, found.z) == these(doctest::Approx(expected.x), doctest::Approx(expected.y), doctest::Approx(expected.z)));
}

}  // namespace binosplat::test
