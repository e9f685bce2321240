"""Where a blade lies in a file, and whether it is one.

In comes a surface in a file's axes and unit; out goes a `pose` to the blade frame (`finding`), from
its root (`root`) and its outer sections (`suction_side`).  Another sign of how a blade lies goes
here.
"""
