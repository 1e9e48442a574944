#!/usr/bin/env python3
"""Runs all command lines of questions.txt and compares the SHA-256 digests of their outputs with the list.

usage: pinned_test.py PROGRAM [--update] [--threads N,...] [--first-only] [--every N]

PROGRAM may be a script that runs the program elsewhere or under an emulator. --update writes the digests into the list
instead. --first-only stops at the first difference. --every N takes each N-th command line. The exit status is 1 if a digest
differs.
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
    arguments = parser.parse_args()
    head, listed = questions.read()
    differing = 0
    for question in listed[::1 if arguments.update else arguments.every]:
        if arguments.update:
            question.pins = questions.ask(arguments.program, question)
            continue
        for threads in map(int, arguments.threads.split(",")):
            # With a checkpoint, the picture is rendered in passes. Without one, it is rendered tile by tile.
            answer = questions.ask(arguments.program, question, threads, with_samples=threads < 7)
            wrong = [name for name, digest in answer.items() if question.pins.get(name) != digest]
            print(f"{'DIFFERENT' if wrong else 'the same '}  {question.text}, threads {threads}", *wrong, flush=True)
            differing += bool(wrong)
        if differing and arguments.first_only:
            break
    if arguments.update:
        questions.write(head, listed)
    elif not listed:
        sys.exit("the list is empty")
    sys.exit(1 if differing else 0)


if __name__ == "__main__":
    main()
