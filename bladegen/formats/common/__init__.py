"""What formats share: documents and tables with places, bounded reading, one grid for all.

In come lines, cells and parsed documents; out go numbers that know where they stood, and the
problems of a whole file at once.  A thing belongs here once two formats use it.
"""
