// Reads the meshes.
#include "xr/extensions/visibility_mask.h"

namespace binosplat::xr {

HiddenMeshes::HiddenMeshes(const Instance& instance, XrSession session, XrViewConfigurationType views)
    : instance_(instance), session_(session), views_(views) {
    for (std::uint32_t eye = 0; eye < 2; ++eye) { read(eye); }
}

void HiddenMeshes::read(std::uint32_t eye) {
    if (!instance_.hasExtension(XR_KHR_VISIBILITY_MASK_EXTENSION_NAME) || eye > 1) { return; }
    HiddenMesh& mesh = meshes_[eye];
    mesh = {};
    ++version_;
    // Some runtimes list the extension but lack its function.
    PFN_xrVoidFunction found = nullptr;
    if (XR_FAILED(xrGetInstanceProcAddr(instance_.handle(), "xrGetVisibilityMaskKHR", &found)) ||
        found == nullptr) {
        return;
    }
    auto mask = structure<XrVisibilityMaskKHR>(XR_TYPE_VISIBILITY_MASK_KHR);
    const auto get = [&] {
        return reinterpret_cast<PFN_xrGetVisibilityMaskKHR>(found)(
            session_, views_, eye, XR_VISIBILITY_MASK_TYPE_HIDDEN_TRIANGLE_MESH_KHR, &mask);
    };
    if (XR_FAILED(get()) || mask.indexCountOutput == 0) { return; }
    mesh.vertices.resize(mask.vertexCountOutput);
    mesh.indices.resize(mask.indexCountOutput);
    mask.vertexCapacityInput = mask.vertexCountOutput;
    mask.indexCapacityInput = mask.indexCountOutput;
    mask.vertices = mesh.vertices.data();
    mask.indices = mesh.indices.data();
    if (XR_FAILED(get())) { mesh = {}; }
}

}  // namespace binosplat::xr
