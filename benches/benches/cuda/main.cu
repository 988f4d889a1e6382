// Times every call of every variant in turns, and prints a row each. `VARIANTS` is a list of `X(model, variant, table)`; the first
// variant of a model is the one that the others are compared with.
//
//   main HITS ROUNDS
#include "bench.cuh"
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#define CHECK(call)                                                                                \
    do {                                                                                           \
        const cudaError_t error = (call);                                                          \
        if (error) {                                                                               \
            fprintf(stderr, "%s: %s\n", #call, cudaGetErrorString(error));                         \
            exit(1);                                                                               \
        }                                                                                          \
    } while (0)

#include "variants.cuh"

struct Variant {
    const char *model, *name;
    const Entry *entries;
};
static const Variant ALL[] = {
#define X(model, name, table) {model, name, table},
    VARIANTS
#undef X
};

// Uniform in [0, 1): 24 bits of a hash of place and column.
static __device__ float uniform(unsigned i, unsigned column) {
    uint64_t z = (uint64_t)i * 16 + column + 1;
    z *= 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (float)((z ^ (z >> 31)) >> 40) * 0x1p-24f;
}

// Directions uniform over the sphere, offsets in [-1, 1), uniform numbers.
static __global__ void fill(Columns columns) {
    const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= columns.count) return;
    for (unsigned k = 0; k < 2; k++) {
        const float *const *w = k ? columns.wi : columns.wo;
        const float u = 2.0f * uniform(i, 2 * k) - 1.0f, across = sqrtf(1.0f - u * u);
        float sine, cosine;
        sincospif(2.0f * uniform(i, 2 * k + 1), &sine, &cosine);
        const float numbers[3] = {u, across * cosine, across * sine};
        for (int c = 0; c < 3; c++) const_cast<float *>(w[c])[i] = numbers[c];
    }
    const_cast<float *>(columns.h)[i] = 2.0f * uniform(i, 4) - 1.0f;
    for (unsigned c = 0; c < 3; c++) const_cast<float *>(columns.xi[c])[i] = uniform(i, 5 + c);
}

static float *column(unsigned count) {
    void *bytes;
    CHECK(cudaMalloc(&bytes, count * sizeof(float)));
    return (float *)bytes;
}

// Milliseconds of a launch.
static float time_of(const Entry &entry, const Columns &columns) {
    static cudaEvent_t start, stop;
    if (!start) {
        CHECK(cudaEventCreate(&start));
        CHECK(cudaEventCreate(&stop));
    }
    CHECK(cudaEventRecord(start));
    entry.launch(columns, columns.count / entry.directions);
    CHECK(cudaEventRecord(stop));
    CHECK(cudaEventSynchronize(stop));
    CHECK(cudaGetLastError());
    float time;
    CHECK(cudaEventElapsedTime(&time, start, stop));
    return time;
}

static std::vector<float> sums_of(const Entry &entry, const Columns &columns) {
    const unsigned count = columns.count / entry.directions;
    CHECK(cudaMemset(columns.sums, 0xff, count * sizeof(float)));
    time_of(entry, columns);
    std::vector<float> sums(count);
    CHECK(cudaMemcpy(sums.data(), columns.sums, count * sizeof(float), cudaMemcpyDeviceToHost));
    return sums;
}

// Difference of sums that 99 of 100 hits stay below, relative to the larger of the two and the mean.
static double difference(const std::vector<float> &these, const std::vector<float> &those) {
    double mean = 0;
    for (float sum : those) mean += std::fabs(sum) / those.size();
    std::vector<double> all(these.size());
    for (size_t i = 0; i < these.size(); i++) {
        const double least = std::max<double>(std::fabs(those[i]), 1e-3 * mean);
        const double relative = std::fabs((double)these[i] - those[i]) / least;
        all[i] = relative >= 0 ? relative : INFINITY;
    }
    auto place = all.begin() + all.size() * 99 / 100;
    std::nth_element(all.begin(), place, all.end());
    return *place;
}

// Prints the rates that bound a kernel: of memory, by a copy, and of operations.
static void print_rates(const Columns &columns) {
    cudaEvent_t start, stop;
    CHECK(cudaEventCreate(&start));
    CHECK(cudaEventCreate(&stop));
    const size_t bytes = columns.count * sizeof(float);
    float best = INFINITY;
    for (int turn = 0; turn < 20; turn++) {
        CHECK(cudaEventRecord(start));
        for (const float *from : columns.wi) CHECK(cudaMemcpyAsync(columns.sums, from, bytes, cudaMemcpyDeviceToDevice));
        CHECK(cudaEventRecord(stop));
        CHECK(cudaEventSynchronize(stop));
        float time;
        CHECK(cudaEventElapsedTime(&time, start, stop));
        best = std::min(best, time);
    }
    int units, clock;
    CHECK(cudaDeviceGetAttribute(&units, cudaDevAttrMultiProcessorCount, 0));
    CHECK(cudaDeviceGetAttribute(&clock, cudaDevAttrClockRate, 0));
    printf("# copies: %.2f TB/s, read and written; %d multiprocessors at most at %.2f GHz\n", 6 * bytes / best * 1e-9, units,
        clock * 1e-6);
}

int main(int argc, char **argv) {
    if (argc != 3) return 2;
    Columns columns;
    columns.count = (unsigned)atoi(argv[1]);
    const int rounds = atoi(argv[2]);
    for (int c = 0; c < 3; c++) {
        columns.wo[c] = column(columns.count);
        columns.wi[c] = column(columns.count);
        columns.xi[c] = column(columns.count);
    }
    columns.h = column(columns.count);
    columns.sums = column(columns.count);
    fill<<<(columns.count + THREADS - 1) / THREADS, THREADS>>>(columns);
    CHECK(cudaDeviceSynchronize());
    print_rates(columns);
    printf("model,variant,call,ns,first_quartile,third_quartile,operations,registers,local_bytes,difference\n");
    struct Row {
        const Variant *variant;
        const Entry *entry;
        double difference;
        std::vector<float> times;
    };
    std::vector<Row> rows;
    bool is_wrong = false;
    const Variant *base = nullptr;
    for (const Variant &variant : ALL) {
        if (!base || std::string(base->model) != variant.model) base = &variant;
        for (int call = 0; call < 5 && variant.entries[call].call; call++) {
            const Entry &entry = variant.entries[call];
            const double apart = difference(sums_of(entry, columns), sums_of(base->entries[call], columns));
            if (!(apart < 1e-2)) {
                is_wrong = true;
                fprintf(stderr, "%s, %s: %s is %g from %s\n", variant.model, variant.name, entry.call, apart, base->name);
            }
            rows.push_back({&variant, &entry, apart, {}});
        }
    }
    // Whatever changes the clock changes it for all.
    for (int round = 0; round < rounds; round++)
        for (size_t i = 0; i < rows.size(); i++) {
            Row &row = rows[round % 2 ? rows.size() - 1 - i : i];
            row.times.push_back(time_of(*row.entry, columns));
        }
    for (Row &row : rows) {
        std::sort(row.times.begin(), row.times.end());
        const auto at = [&](double share) { return row.times[(size_t)(share * (row.times.size() - 1))] * 1e6 / columns.count; };
        cudaFuncAttributes attributes;
        CHECK(cudaFuncGetAttributes(&attributes, row.entry->kernel));
        printf("%s,%s,%s,%.5f,%.5f,%.5f,%u,%d,%zu,%.1e\n", row.variant->model, row.variant->name, row.entry->call, at(0.5), at(0.25),
            at(0.75), row.entry->operations, attributes.numRegs, attributes.localSizeBytes, row.difference);
    }
    return is_wrong;
}
