"""Runs the program: python -m microtrace."""

from microtrace_program import main

main()
