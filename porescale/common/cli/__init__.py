"""The command line that both packages have: the application, and one file for each shared command."""
