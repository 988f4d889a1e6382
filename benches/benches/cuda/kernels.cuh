// Kernels of the calls of one model: one thread per hit, every hit with arguments of its own, one material.
//
// Before it: `bench.cuh`, the model, and the macros NAME (of the table), CALL and TYPE (of functions and structs), PRESET, OPERATIONS
// and, where there are derivatives, GRADIENT.

#define ARGUMENTS const __grid_constant__ TYPE(Material) material, const __grid_constant__ Columns columns
#define HIT(count)                                                                                 \
    const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;                                      \
    if (i >= (count)) return;                                                                      \
    const HairisVec3 wo = vector(columns.wo, i);                                                   \
    const float h = columns.h[i]

static __device__ HairisVec3 vector(const float *const *columns, unsigned i) {
    return hairis_vec3(columns[0][i], columns[1][i], columns[2][i]);
}

// Sum of the numbers of a result: each of them is computed.
template <typename T> static __device__ float sum(const T &result) {
    float numbers[sizeof(T) / sizeof(float)], sum = 0.0f;
    memcpy(numbers, &result, sizeof(T));
#pragma unroll
    for (float number : numbers) sum += number;
    return sum;
}

static __global__ void eval_hit(ARGUMENTS) {
    HIT(columns.count);
    columns.sums[i] = sum(CALL(eval_hit)(material, wo, h, vector(columns.wi, i)));
}

static __global__ void sample_hit(ARGUMENTS) {
    HIT(columns.count);
    columns.sums[i] = sum(CALL(sample_hit)(material, wo, h, vector(columns.xi, i)));
}

static __global__ void eval_sample_hit(ARGUMENTS) {
    HIT(columns.count);
    columns.sums[i] = sum(CALL(eval_sample_hit)(material, wo, h, vector(columns.wi, i), vector(columns.xi, i)));
}

// A shading point and sixteen directions.
static __global__ void eval(ARGUMENTS) {
    const unsigned points = columns.count / DIRECTIONS;
    HIT(points);
    const TYPE(Prepared) prepared = CALL(prepare)(material, wo, h);
    float all = 0.0f;
    for (unsigned k = 0; k < DIRECTIONS; k++) all += sum(CALL(eval)(prepared, vector(columns.wi, i + k * points)));
    columns.sums[i] = all;
}

#ifdef GRADIENT
static __global__ void eval_hit_gradient(ARGUMENTS) {
    HIT(columns.count);
    TYPE(Eval) weights;
    weights.value = vector(columns.xi, i);
    weights.pdf = h;
    columns.sums[i] = sum(CALL(eval_hit_gradient)(material, wo, h, vector(columns.wi, i), weights));
}
#endif

template <void (*KERNEL)(TYPE(Material), Columns)> static void launch(const Columns &columns, unsigned count) {
    static const TYPE(Material) material = CALL(material)(PRESET());
    KERNEL<<<(count + THREADS - 1) / THREADS, THREADS>>>(material, columns);
}

#define ENTRY(call, place, directions) {#call, operations[place], (const void *)call, launch<call>, directions}

static constexpr unsigned operations[5] = {OPERATIONS};

extern "C" const Entry NAME[5] = {
    ENTRY(eval_hit, 0, 1),
    ENTRY(sample_hit, 1, 1),
    ENTRY(eval_sample_hit, 2, 1),
    ENTRY(eval, 3, DIRECTIONS),
#ifdef GRADIENT
    ENTRY(eval_hit_gradient, 4, 1),
#endif
};
