"""What a page lets choose between: how a blade is made, how files are, what colours mean.

Each choice is a frozen value that a `state` holds, with a key or two in its link.
"""
