"""Brown hair of every model: its lobes about the fibre, and the map over the sphere. plot.py [FILE]"""

import sys

import hairis
import hairis.plot
import matplotlib

matplotlib.use("agg")
import matplotlib.pyplot as plt

figure = plt.figure(figsize=(16, 8), layout="constrained")
names = list(hairis.models())
for place, name in enumerate(names, 1):
    bsdf = hairis.Material(name, "brown").prepare((0.5, 0.75**0.5, 0.0))
    hairis.plot.polar(bsdf, axes=figure.add_subplot(2, len(names), place, projection="polar"))
    hairis.plot.sphere(bsdf, axes=figure.add_subplot(2, len(names), len(names) + place, title=name))
file = sys.argv[1] if len(sys.argv) > 1 else "hair.png"
figure.savefig(file)
print(file)
