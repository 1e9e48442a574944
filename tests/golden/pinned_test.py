#!/usr/bin/env python3
"""Runs all command lines of questions.txt and compares the SHA-256 digests of their outputs with the list.

usage: pinned_test.py PROGRAM [--update] [--threads N,...] [--first-only] [--every N] [--without-modules]

PROGRAM may be a script that runs the program elsewhere or under an emulator. --update writes the digests into the list
instead. --first-only stops at the first difference. --every N takes each N-th command line. --without-modules leaves out
command lines that need modules which PROGRAM lacks. The exit status is 1 if a digest differs.
"""

import argparse
import os
import sys

import questions


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program", type=os.path.abspath)
    parser.add_argument("--update", action="store_true")
    parser.add_argument("--threads", default="1,2,7")
    parser.add_argument("--first-only", action="store_true")
    parser.add_argument("--every", type=int, default=1)
    parser.add_argument("--without-modules", action="store_true")
    arguments = parser.parse_args()
    head, listed = questions.read()
    differing = compared = 0
    for question in listed[::1 if arguments.update else arguments.every]:
        if arguments.update:
            question.pins = questions.ask(arguments.program, question)
            continue
        for threads in map(int, arguments.threads.split(",")):
            # With a checkpoint, the picture is rendered in passes. Without one, it is rendered tile by tile.
            try:
                answer = questions.ask(arguments.program, question, threads, with_samples=threads < 7)
            except questions.MissingModule:
                if not arguments.without_modules:
                    raise
                print(f"left out   {question.text}")
                continue
            compared += 1
            wrong = [name for name, digest in answer.items() if question.pins.get(name) != digest]
            print(f"{'DIFFERENT' if wrong else 'the same '}  {question.text}, threads {threads}", *wrong, flush=True)
            differing += bool(wrong)
        if differing and arguments.first_only:
            break
    if arguments.update:
        questions.write(head, listed)
    elif not compared:
        sys.exit("nothing is compared")
    sys.exit(1 if differing else 0)


if __name__ == "__main__":
    main()
