// Linked into every program of the sanitizer build. Drivers and loaders are not sanitized and keep some
// memory to the end. They stay loaded so that the leak sanitizer knows whose memory it is: an unloaded
// library has no name any more.
#pragma GCC visibility push(default)
extern "C" {

int dlclose(void*);
int dlclose(void*) { return 0; }

// OpenXR's loader 1.0.20 leaks 1304 bytes with every instance that is created and destroyed.
const char* __lsan_default_suppressions();
const char* __lsan_default_suppressions() {
    return "leak:libLLVM\n"
           "leak:libvulkan_lvp\n"
           "leak:libVkLayer_khronos_validation\n"
           "leak:libopenxr_loader\n"
           "leak:libXrApiLayer_core_validation\n";
}
const char* __lsan_default_options();
const char* __lsan_default_options() { return "print_suppressions=0"; }

}  // extern "C"
#pragma GCC visibility pop
