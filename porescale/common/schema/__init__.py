"""TOML or Python into typed sections, with every fault of a file in one message each."""
