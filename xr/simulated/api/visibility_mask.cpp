// XR_KHR_visibility_mask: the part of the picture that the lens never shows. Empty unless the script turns it
// on, as on many runtimes.
#include <cstdlib>

#include "xr/simulated/api/api.h"
#include "xr/simulated/api/structures.h"
#include "xr/simulated/api/views.h"

namespace simulated {
namespace {

Mesh meshOf(const Fov& fov, XrVisibilityMaskTypeKHR type) {
    switch (type) {
        case XR_VISIBILITY_MASK_TYPE_HIDDEN_TRIANGLE_MESH_KHR:
            return makeHiddenMesh(fov);
        case XR_VISIBILITY_MASK_TYPE_VISIBLE_TRIANGLE_MESH_KHR:
            return makeVisibleMesh(fov);
        case XR_VISIBILITY_MASK_TYPE_LINE_LOOP_KHR:
            return makeVisibleOutline(fov);
        default:
            refuse(XR_ERROR_VALIDATION_FAILURE, type, " is not a type of mask");
    }
}

}  // namespace

XrResult xrGetVisibilityMaskKHR(XrSession session, XrViewConfigurationType viewConfigurationType,
                                uint32_t viewIndex, XrVisibilityMaskTypeKHR visibilityMaskType,
                                XrVisibilityMaskKHR* visibilityMask) {
    return answerFor<Session>(__func__, session, [&](const Session& owner) {
        checkViewConfiguration(owner.instance, viewConfigurationType);
        const std::size_t count = countViews(viewConfigurationType);
        require(viewIndex < count, XR_ERROR_VALIDATION_FAILURE, "the view is ", viewIndex,
                ", must be less than ", count);
        XrVisibilityMaskKHR& output = checkStruct(visibilityMask, XR_TYPE_VISIBILITY_MASK_KHR);
        const Simulation& simulation = *owner.instance.simulation;
        Mesh mesh =
            meshOf(simulation.at(simulation.clock.now()).eyes[sideOf(viewIndex)].fov, visibilityMaskType);
        if (simulation.script.visibility_mask_is_broken) { std::abort(); }
        // Lenses hide nothing of an inset.
        if (!simulation.script.visibility_mask || isInset(viewIndex)) { mesh = {}; }
        output.vertexCountOutput = static_cast<std::uint32_t>(mesh.vertices.size());
        output.indexCountOutput = static_cast<std::uint32_t>(mesh.indices.size());
        if (output.vertexCapacityInput == 0 || output.indexCapacityInput == 0) { return; }
        const bool has_room = output.vertexCapacityInput >= mesh.vertices.size() &&
                              output.indexCapacityInput >= mesh.indices.size();
        require(has_room, XR_ERROR_SIZE_INSUFFICIENT, "the arrays have room for ", output.vertexCapacityInput,
                " vertices and ", output.indexCapacityInput, " indices, must have for ", mesh.vertices.size(),
                " and ", mesh.indices.size());
        require(output.vertices != nullptr && output.indices != nullptr, XR_ERROR_VALIDATION_FAILURE,
                "an array is missing");
        for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
            output.vertices[i] = {mesh.vertices[i].x, mesh.vertices[i].y};
        }
        for (std::size_t i = 0; i < mesh.indices.size(); ++i) { output.indices[i] = mesh.indices[i]; }
    });
}

}  // namespace simulated
