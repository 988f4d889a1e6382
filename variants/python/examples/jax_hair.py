"""Recovers the widths of lobes from values, with JAX: jax_hair.py"""

import hairis.jax
import jax
import jax.numpy as jnp


def directions(key: int) -> jax.Array:
    v = jax.random.normal(jax.random.key(key), (4096, 3))
    return jnp.divide(v, jnp.linalg.norm(v, axis=-1, keepdims=True))


wo, wi = directions(1), directions(2)
target = hairis.jax.material("gaussian", "brown").eval(wo, wi)
hidden = jnp.array(hairis.Material("gaussian", "brown").fields["beta"])


@jax.jit
@jax.value_and_grad
def loss(log_beta: jax.Array) -> jax.Array:
    value = hairis.jax.material("gaussian", "brown", beta=jnp.exp(log_beta)).eval(wo, wi)
    return jnp.mean((value - target) ** 2) / jnp.mean(target**2)


log_beta, mean, square = jnp.log(1.3 * hidden), jnp.zeros(3), jnp.zeros(3)
for k in range(1, 301):  # Adam
    value, gradient = loss(log_beta)
    mean, square = 0.9 * mean + 0.1 * gradient, 0.99 * square + 0.01 * gradient**2
    log_beta -= 0.02 * 0.985**k * (mean / (1 - 0.9**k)) / (jnp.sqrt(square / (1 - 0.99**k)) + 1e-12)
print(f"loss {value:.1e}; widths {jnp.exp(log_beta)}, hidden {hidden}")
