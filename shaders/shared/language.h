// Lets C++ and GLSL read the same header: vector types with the same layout (GLSL's `scalar`) and typed
// device addresses.
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

// The address of an array of T must be a multiple of this: see BINOSPLAT_ALIGNED_ARRAY_OF.
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
// Elements begin at multiples of `align` bytes, so that one access loads a whole element even on devices that
// require alignment.
#define BINOSPLAT_ALIGNED_ARRAY_OF(Element, align, Name) \
    layout(buffer_reference, scalar, buffer_reference_align = align) buffer Name { Element at[]; }
// For arrays in which workgroups read what others in the same dispatch have written; see lib/last_group.glsl.
#define BINOSPLAT_COHERENT_ARRAY_OF(Element, Name) \
    layout(buffer_reference, scalar, buffer_reference_align = 4) coherent buffer Name { Element at[]; }
// The address, stored in memory, of an array aligned to less than eight bytes; Name(it) is the array. A
// number, because glslang would also give the load of an address the array's alignment, where Vulkan requires
// eight. Other arrays keep addresses: a 64-bit load is cheaper.
#define BINOSPLAT_STORED(Name) uvec2
#define BINOSPLAT_CONSTANT const

#endif

#endif
