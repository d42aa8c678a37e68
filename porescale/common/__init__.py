"""What both simulators share: no fluid, no grain.  Imports nothing of porescale outside itself."""
