"""Other solvers behind one protocol: one file per peer, each of which may be missing."""
