"""windIO turbine files in YAML or JSON, versions 1 and 2.

In comes a parsed document; out goes its blade's outer shape, or the other way; `into` puts a blade
back into a turbine.  What both versions share stands in `reading` and `writing`, what one has alone
in `version1` and `version2`.
"""
