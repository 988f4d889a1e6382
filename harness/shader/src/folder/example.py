"""Shades one hair: python3 example.py"""

import hairis_MODEL as model

params = model.params_brown()  # replace its fields: help(model.Params)
hair = model.material(params)  # once per material
wo = (0.6, 0.8, 0.0)  # towards the viewer, in the frame of the fibre, x along it; arrays of many hits as well
point = model.prepare(hair, wo, 0.0)  # once per hit, in the middle of the fibre

wi = (-0.6, 0.64, 0.48)  # towards a light
e = model.eval(point, wi)  # value is without the cosine
print("value {:.3f} {:.3f} {:.3f}, pdf {:.3f}".format(*e.value, e.pdf))

xi = (0.3, 0.6, 0.9)  # uniform in [0, 1)
s = model.sample(point, xi)
if s.slot >= 0:  # -1: discarded, the path ends
    print("sample {:.3f} {:.3f} {:.3f}, weight {:.3f} {:.3f} {:.3f}".format(*s.wi, *s.weight))
