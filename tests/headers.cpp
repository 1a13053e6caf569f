// Empty: CMake precompiles the shared headers only for a target that has a source.
