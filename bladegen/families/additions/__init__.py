"""What is added to a family's folder: more variants (`growth`), labels (`later_labels`).

In comes the folder of a family that is whole or was; out comes the same folder with more in it, as
if all had been made at once.  Another thing that is added afterwards goes here.
"""
