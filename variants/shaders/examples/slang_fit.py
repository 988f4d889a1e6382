"""Recovers the widths of lobes by the derivatives of Slang: slang_fit.py cpu (or vulkan, cuda, metal, d3d12)"""
import sys
import numpy as np
import slangpy
SOURCE = """
import hairis_gaussian;  // hairis shader --model gaussian --target slang > hairis_gaussian.slang
StructuredBuffer<float4> widths, wo, wi; RWStructuredBuffer<float4> result;
[Differentiable] float3 value(float3 beta, no_diff float3 wo, no_diff float3 wi) {
    HairisGaussianParams params = hairis_gaussian_params_brown();
    params.beta = { beta.x, beta.y, beta.z };
    return hairis_gaussian_eval_hit(hairis_gaussian_material(params), wo, 0.0, wi).value;
}
[shader("compute")] [numthreads(64, 1, 1)] void differentiate(uint3 id : SV_DispatchThreadID) {
    float3 o = wo[id.x].xyz, i = wi[id.x].xyz, error = value(widths[0].xyz, o, i) - value(widths[1].xyz, o, i);
    var beta = diffPair(widths[0].xyz);
    bwd_diff(value)(beta, o, i, 2.0 * error);
    result[id.x] = float4(beta.d, dot(error, error));
}"""
device = slangpy.create_device(slangpy.DeviceType[sys.argv[1]], include_paths=["."])
module = device.load_module_from_source("fit", SOURCE)
kernel = device.create_compute_kernel(device.link_program([module], [module.entry_point("differentiate")]))
usage = slangpy.BufferUsage.shader_resource | slangpy.BufferUsage.unordered_access
buffer = lambda rows: device.create_buffer(data=np.float32(rows), struct_size=16, usage=usage)
wo, wi = (buffer(v / np.linalg.norm(v[:, :3], axis=1, keepdims=True)) for v in np.random.default_rng(1).normal(size=(2, 4096, 4)))
widths, result = np.array([[0.17, 0.085, 0.34, 0.0], [0.131, 0.0654, 0.262, 0.0]]), buffer(np.zeros((4096, 4)))
for step in range(300):  # by the signs of the slopes, in the logarithm of the widths
    kernel.dispatch([4096, 1, 1], vars={"widths": buffer(widths), "wo": wo, "wi": wi, "result": result})
    *slope, loss = result.to_numpy().view(np.float32).reshape(4096, 4).mean(axis=0)
    widths[0, :3] *= np.exp(-0.02 * 0.97**step * np.sign(slope))
print(f"loss {loss:.1e}; widths {widths[0, :3].round(4)}, hidden {widths[1, :3]}")
