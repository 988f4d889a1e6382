"""Recovers the widths of lobes from values, with PyTorch: torch_hair.py"""

from __future__ import annotations

import hairis.torch
import torch


def directions(seed: int) -> torch.Tensor:
    v = torch.randn((4096, 3), generator=torch.Generator().manual_seed(seed))
    return torch.nn.functional.normalize(v, dim=-1)


wo, wi = directions(1), directions(2)
target = hairis.torch.material("gaussian", "brown").eval(wo, wi)
hidden = torch.tensor(hairis.Material("gaussian", "brown").fields["beta"])

log_beta = torch.log(1.3 * hidden).requires_grad_()
optimiser = torch.optim.Adam([log_beta], lr=0.02)
schedule = torch.optim.lr_scheduler.ExponentialLR(optimiser, 0.985)
for _ in range(300):
    optimiser.zero_grad()
    value = hairis.torch.material("gaussian", "brown", beta=log_beta.exp()).eval(wo, wi)
    loss = ((value - target) ** 2).mean() / (target**2).mean()
    loss.backward()
    optimiser.step()
    schedule.step()
print(f"loss {loss.item():.1e}; widths {log_beta.exp().tolist()}, hidden {hidden.tolist()}")
