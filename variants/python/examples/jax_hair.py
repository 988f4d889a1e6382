"""Hair as a function that JAX differentiates, which recovers the widths of lobes from values. jax_hair.py

`scatter` is a `custom_vjp` over the wheel's calls on columns, so that a loss of its values has gradients by every field and direction.
"""

from __future__ import annotations

from functools import partial
from typing import Any

import hairis
import jax
import jax.numpy as jnp
import numpy as np

Fields = dict[str, Any]


def material(model: str, fields: Fields) -> hairis.Material:
    numbers: Fields = {name: np.asarray(value) for name, value in fields.items()}
    return hairis.Material(model, energy="raw", **numbers)


@partial(jax.custom_vjp, nondiff_argnums=(0,))
def scatter(model: str, fields: Fields, wo: jax.Array, wi: jax.Array) -> jax.Array:
    """Returns S of N directions, each at a hit of its own, as an array of shape (3, N)."""

    def call(fields: Fields, wo: Any, wi: Any) -> Any:
        return material(model, fields).eval_hits(np.asarray(wo), np.asarray(wi))["value"]

    value: jax.Array = jax.pure_callback(call, jax.ShapeDtypeStruct(wo.shape, jnp.float32), fields, wo, wi)
    return value


def forward(model: str, fields: Fields, wo: jax.Array, wi: jax.Array) -> tuple[jax.Array, Any]:
    return scatter(model, fields, wo, wi), (fields, wo, wi)


def backward(model: str, saved: Any, d_value: jax.Array) -> Any:
    def call(fields: Fields, wo: Any, wi: Any, d_value: Any) -> Any:
        columns, d_fields = material(model, fields).eval_grad(np.asarray(wo), np.asarray(wi), np.asarray(d_value))
        by_field = {name: np.asarray(d_fields[name], np.float32) for name in fields}
        return by_field, columns["d_wo"], columns["d_wi"]

    shapes = jax.tree.map(lambda x: jax.ShapeDtypeStruct(x.shape, jnp.float32), saved)
    return jax.pure_callback(call, shapes, *saved, d_value)


scatter.defvjp(forward, backward)


def directions(n: int, seed: int) -> jax.Array:
    v = np.random.default_rng(seed).normal(size=(3, n))
    return jnp.asarray(v / np.linalg.norm(v, axis=0), jnp.float32)


def main() -> None:
    wo, wi = directions(4096, 1), directions(4096, 2)
    brown = hairis.Material("gaussian", "brown", energy="raw").fields
    given = {name: jnp.asarray(value, jnp.float32) for name, value in brown.items()}
    target = scatter("gaussian", given, wo, wi)

    @jax.jit
    def loss(log_beta: jax.Array) -> jax.Array:
        fields = {**given, "beta": jnp.exp(log_beta)}
        return jnp.mean((scatter("gaussian", fields, wo, wi) - target) ** 2) / jnp.mean(target**2)

    step = jax.jit(jax.value_and_grad(loss))
    log_beta, mean, square = jnp.log(1.3 * given["beta"]), jnp.zeros(3), jnp.zeros(3)
    # Adam.
    for k in range(1, 301):
        value, gradient = step(log_beta)
        mean, square = 0.9 * mean + 0.1 * gradient, 0.99 * square + 0.01 * gradient**2
        log_beta -= 0.02 * 0.985**k * (mean / (1 - 0.9**k)) / (jnp.sqrt(square / (1 - 0.99**k)) + 1e-12)
        if k % 100 == 0:
            print(f"step {k}: loss {value:.2e}, widths {np.round(np.asarray(jnp.exp(log_beta)), 5)}")
    print("the widths were", np.round(np.asarray(given["beta"]), 5))


if __name__ == "__main__":
    main()
