// What the kernels of all models share with the program that times them.
#include <cstdint>
#include <cstring>

// Directions per shading point of `eval`.
#define DIRECTIONS 16u
// Threads of a block.
#define THREADS 128u

// Arguments of all hits, by component, and the sum of each hit's results.
struct Columns {
    const float *wo[3], *h, *wi[3], *xi[3];
    float *sums;
    unsigned count;
};

// A call of a model: its kernel, and a function that launches it for so many threads; operations per direction, where known.
struct Entry {
    const char *call;
    unsigned operations;
    const void *kernel;
    void (*launch)(const Columns &, unsigned count);
    unsigned directions;
};
