"""Many perturbed blades at once, as arrays.

In come a blade and a design of experiments (`designs`, `draws`); out come the sections of
thousands of variants, each measured and tested (`batch`), by compiled loops (`kernels`, `sizes`).
A new design goes here.
"""
