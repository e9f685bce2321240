"""What lies inside the skin as a designer gives it: materials, webs, layers, and where they lie.

Places on a section are rules (`positions`), so that they hold on a perturbed blade, too; the room
`layup` finds them on a blade's sections.  A new way to say where something lies goes here.
"""
