// Laptops with two GPUs: their drivers look for these names, and give the program the fast one.
extern "C" {
__declspec(dllexport) extern const unsigned long NvOptimusEnablement;
__declspec(dllexport) extern const unsigned long AmdPowerXpressRequestHighPerformance;
const unsigned long NvOptimusEnablement = 1;
const unsigned long AmdPowerXpressRequestHighPerformance = 1;
}
