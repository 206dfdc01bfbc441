"""The viewer: a node with a live page in the browser. What is shown is plain Python; only the page knows viser."""
