"""How each format's file is written from a blade's products, by the kind of product.

Each function takes `Products` and a path; `registry` says which format it stands for.
"""
