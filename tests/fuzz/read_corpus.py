#!/usr/bin/python3
"""What the fuzzer has found (corpus.tar.xz, see tests/fuzz.sh) is read or refused: read_corpus.py TESTS-PROGRAM"""
import os, pathlib, subprocess, sys, tarfile, tempfile

with tempfile.TemporaryDirectory() as folder:
    with tarfile.open(pathlib.Path(__file__).parent / "corpus.tar.xz") as kept:
        kept.extractall(folder)
    environment = dict(os.environ, LIGHTWALK_FUZZ_CORPUS=folder)
    sys.exit(subprocess.run([sys.argv[1], "-tc=the kept corpus of the fuzzer is read or refused"], env=environment).returncode)
