/* A program that includes this file first ends with SIGFPE at an invalid operation, a division by zero or an overflow. */
#include <fenv.h>
__attribute__((constructor)) static void trap(void) { feenableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW); }
