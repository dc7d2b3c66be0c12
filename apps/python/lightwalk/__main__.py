"""The program: `python -m lightwalk`."""

import lightwalk_program

lightwalk_program.main()
