// Makes any device call fail, chosen by its number, for a process that tests itself, through the functions
// below (dlsym). Needs BINOSPLAT_FAULT_ANY=1 when the device is created.
#pragma once

#include <vulkan/vulkan.h>

namespace binosplat::faults {

// `next`, or a function that may fail before it is called.
PFN_vkVoidFunction fallible(const char* name, PFN_vkVoidFunction next);

}  // namespace binosplat::faults

extern "C" {
// Makes the Nth such call from now on fail once with this VkResult; with 0, none.
void binosplat_faults_arm(int number, int result);
// The name of the call that has failed since then; null if there were fewer calls.
const char* binosplat_faults_struck();
// The number of objects and allocations that exist; see live.h.
long long binosplat_faults_live();
}
