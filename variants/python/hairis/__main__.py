"""Prints the version, the instruction set of this machine, and the models with their presets: python -m hairis."""

from importlib.metadata import version

from . import level, models

print(f"hairis {version('hairis')}, eight lanes on {level()}")
for name, model in models().items():
    print(f"  {name}: presets {', '.join(model['presets'])}")
