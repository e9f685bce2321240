"""NuMAD workbooks and project files, as NuMAD and pyNuMAD have them; read only.

In comes a workbook or an .nmd file; out goes a definition, of a workbook of NuMAD 3 with what lies
inside its skin (`components`, `keypoints`, `materials`).
"""
