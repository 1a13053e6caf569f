// What lets one header be read by C++ and by GLSL: vector types of equal layout (GLSL's `scalar`) and typed device addresses.
#ifndef BINOSPLAT_SHADERS_SHARED_LANGUAGE_H
#define BINOSPLAT_SHADERS_SHARED_LANGUAGE_H

#ifdef __cplusplus

#include <cstdint>
#include <glm/glm.hpp>

namespace binosplat::gpu {

using uint = std::uint32_t;
using glm::ivec2;
using glm::ivec4;
using glm::uvec2;
using glm::uvec3;
using glm::uvec4;
using glm::vec2;
using glm::vec3;
using glm::vec4;

// What the address of an array of T must be a multiple of: see BINOSPLAT_ALIGNED_ARRAY_OF.
template <typename T>
inline constexpr std::uint64_t kArrayAlignment = 4;
template <>
inline constexpr std::uint64_t kArrayAlignment<vec2> = 8;
template <>
inline constexpr std::uint64_t kArrayAlignment<uvec2> = 8;
template <>
inline constexpr std::uint64_t kArrayAlignment<vec4> = 16;

// The address of an array of T in device memory. Eight bytes, like GLSL's buffer_reference.
template <typename T>
struct DeviceAddress {
    std::uint64_t value = 0;
    // The address of element `index`.
    [[nodiscard]] DeviceAddress at(std::uint64_t index) const { return {value + index * sizeof(T)}; }
};

}  // namespace binosplat::gpu

#define BINOSPLAT_BEGIN_SHARED namespace binosplat::gpu {
#define BINOSPLAT_END_SHARED }
#define BINOSPLAT_ARRAY_OF(Element, Name) using Name = DeviceAddress<Element>
#define BINOSPLAT_ALIGNED_ARRAY_OF(Element, Align, Name) using Name = DeviceAddress<Element>
#define BINOSPLAT_COHERENT_ARRAY_OF(Element, Name) using Name = DeviceAddress<Element>
#define BINOSPLAT_STORED(Name) Name
#define BINOSPLAT_CONSTANT inline constexpr

#else

#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_scalar_block_layout : require

#define BINOSPLAT_BEGIN_SHARED
#define BINOSPLAT_END_SHARED
// In a shader `name.at[i]` is element i.
#define BINOSPLAT_ARRAY_OF(Element, Name) BINOSPLAT_ALIGNED_ARRAY_OF(Element, 4, Name)
// Of elements that begin at a multiple of `align` bytes, so that one access takes a whole one also where a device wants it to lie so.
#define BINOSPLAT_ALIGNED_ARRAY_OF(Element, align, Name) \
    layout(buffer_reference, scalar, buffer_reference_align = align) buffer Name { Element at[]; }
// Where workgroups read what others of the same dispatch have written; see lib/last_group.glsl.
#define BINOSPLAT_COHERENT_ARRAY_OF(Element, Name) \
    layout(buffer_reference, scalar, buffer_reference_align = 4) coherent buffer Name { Element at[]; }
// An address, in memory, of an array that is aligned to less than eight bytes; Name(it) is the array. As a number: glslang would say of its
// load, too, that it is aligned to less, where Vulkan asks for eight. Others are addresses, since a load of 64 bits is cheaper.
#define BINOSPLAT_STORED(Name) uvec2
#define BINOSPLAT_CONSTANT const

#endif

#endif
