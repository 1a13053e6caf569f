// The program's entry point.
#include "app/program.h"

int main(int argument_count, char** arguments) { return binosplat::runProgram(argument_count, arguments); }
