// For laptops with two GPUs, whose drivers look for these symbols and then give the program the fast GPU.
extern "C" {
__declspec(dllexport) extern const unsigned long NvOptimusEnablement;
__declspec(dllexport) extern const unsigned long AmdPowerXpressRequestHighPerformance;
const unsigned long NvOptimusEnablement = 1;
const unsigned long AmdPowerXpressRequestHighPerformance = 1;
}
