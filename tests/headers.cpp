// Empty: CMake generates the headers that test programs share only for a target with a source that includes
// them.
