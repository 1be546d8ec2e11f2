"""`python -m hilbed` is `hilbed`."""

from hilbed.cli import main

if __name__ == "__main__":
    main()
