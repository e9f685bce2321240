"""The inner surface of a blade's wall, below its outer surface by what its layers are thick.

In come the net of a blade's surface and a `Layup`; out goes the net of the surface inside
(`inner`), fitted to the inner side of the wall (`wall`), which is kept from crossing itself where
there is no room for it (`room`), and findings on where that is (`limits`).
"""
