# SPDX-License-Identifier: BSD-3-Clause
"""Runs the study of a file: ``sweep_script.py STUDY STORE WORKERS_OR_EXECUTOR``."""

import sys

import railsym as rs

if __name__ == "__main__":
    _, study, store, where = sys.argv
    place = {"workers": int(where)} if where.isdigit() else {"executor": where}
    print(rs.Study.load(study).run(store, **place).message)
