"""The examples of docs/algebra.md give what the page says."""

import doctest
from pathlib import Path

import pytest

PAGE = Path(__file__).parents[3] / "docs" / "algebra.md"


@pytest.mark.skipif(not PAGE.exists(), reason="the package stands apart from the repository's docs")
def test_examples_of_the_page():
    result = doctest.testfile(str(PAGE), module_relative=False, optionflags=doctest.NORMALIZE_WHITESPACE)
    assert result.attempted > 25
    assert result.failed == 0
