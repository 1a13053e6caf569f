// Checks of every structure and array that an application passes: types, next chains, the two-call idiom,
// fixed strings.
#pragma once

#include <algorithm>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "xr/simulated/api/answer.h"
#include "xr/simulated/openxr.h"

namespace simulated {

// Unknown structures in a chain are skipped, as the specification demands; a chain that never ends is
// refused.
void checkChain(const void* next);
// Null if there is none.
const XrBaseInStructure* findInChain(const void* next, XrStructureType type);
template <class T>
T* findInChain(const void* next, XrStructureType type) {
    return reinterpret_cast<T*>(const_cast<XrBaseInStructure*>(findInChain(next, type)));
}

template <class T>
void checkType(const T& structure, XrStructureType type) {
    require(structure.type == type, XR_ERROR_VALIDATION_FAILURE, "a structure is of type ", structure.type,
            ", must be ", type);
    checkChain(structure.next);
}

template <class T>
T& checkStruct(T* structure, XrStructureType type) {
    require(structure != nullptr, XR_ERROR_VALIDATION_FAILURE, "the structure of type ", type, " is missing");
    checkType(*structure, type);
    return *structure;
}

// For optional structures.
template <class T>
void checkOptional(const T* structure, XrStructureType type) {
    if (structure != nullptr) { checkType(*structure, type); }
}

template <class T>
T& checkOutput(T* output) {
    require(output != nullptr, XR_ERROR_VALIDATION_FAILURE, "a place for the result is missing");
    return *output;
}

// `what` names the contents for a message.
template <class T>
std::span<T> checkArray(T* array, std::uint32_t count, const char* what) {
    require(array != nullptr || count == 0, XR_ERROR_VALIDATION_FAILURE, "the array of ", count, " ", what,
            " is missing");
    return {array, count};
}

// Requires at least one flag, and only known ones.
inline void checkFlags(XrFlags64 flags, XrFlags64 known, const char* name) {
    require(flags != 0 && (flags & ~known) == 0, XR_ERROR_VALIDATION_FAILURE, name, " is ", flags,
            ", must be of the bits ", known);
}

// The two-call idiom's first half. True: there is space, so copy. False: only the count was asked for.
inline bool wantsArray(std::uint32_t capacity, std::uint32_t* count, const void* array, std::size_t size) {
    require(count != nullptr, XR_ERROR_VALIDATION_FAILURE, "a place for the count is missing");
    *count = static_cast<std::uint32_t>(size);
    if (capacity == 0) { return false; }
    require(capacity >= size, XR_ERROR_SIZE_INSUFFICIENT, "the array has room for ", capacity,
            ", must have for ", size);
    require(array != nullptr || size == 0, XR_ERROR_VALIDATION_FAILURE, "an array is missing");
    return true;
}

template <class T>
void fillArray(std::uint32_t capacity, std::uint32_t* count, T* array, const std::vector<T>& values) {
    if (wantsArray(capacity, count, array, values.size())) { std::ranges::copy(values, array); }
}

// With the terminating zero, which is counted.
inline void fillString(std::uint32_t capacity, std::uint32_t* count, char* buffer, const std::string& text) {
    if (wantsArray(capacity, count, buffer, text.size() + 1)) {
        std::memcpy(buffer, text.c_str(), text.size() + 1);
    }
}

// An application's text, in quotes and without characters that a line cannot show.
std::string makePrintable(std::string_view text);
// A fixed array's text; XR_ERROR_VALIDATION_FAILURE if it is not terminated or not UTF-8.
std::string textOf(const char* characters, std::size_t size);
template <std::size_t size>
std::string textOf(const char (&characters)[size]) {
    return textOf(characters, size);
}

template <std::size_t size>
void copyText(char (&destination)[size], std::string_view text) {
    destination[text.copy(destination, size - 1)] = '\0';
}

}  // namespace simulated
