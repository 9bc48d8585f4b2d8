# Runs what the LumiBench paper shows, and writes one report with its tables, figures and statements.
# SPDX-License-Identifier: Apache-2.0
"""The program behind `glint paper`: `plan.py` says what is run, `running.py` runs it, `statements.py` judges, `page.py` writes the report."""
