// Any call of the device that may fail, by its number: for a process that tests itself, by the functions below (dlsym). Needs
// BINOSPLAT_FAULT_ANY=1 as the device is made.
#pragma once

#include <vulkan/vulkan.h>

namespace binosplat::faults {

// `next`, or a function that may fail before it is called.
PFN_vkVoidFunction fallible(const char* name, PFN_vkVoidFunction next);

}  // namespace binosplat::faults

extern "C" {
// The Nth such call from now on fails with this VkResult, once; 0: none does.
void binosplat_faults_arm(int number, int result);
// The name of the call that has failed since; null: there were fewer calls.
const char* binosplat_faults_struck();
// Existing objects and allocations, see live.h.
long long binosplat_faults_live();
}
