"""`python -m bladegen`: the command line."""

from bladegen.cli.commands import main

if __name__ == "__main__":
    main()
