"""What counts as news of the device: by stamps, positions and the clock that made the stamps."""

import numpy as np
import pytest

from gaik_ros.state_news import StateNews

HERE, THERE, SECOND = np.array([0.1, 0.2, 0.3]), np.array([0.1, 0.2, 0.4]), 1_000_000_000


def test_a_message_over_again_is_no_news_but_another_stamp_or_position_is():
    news = StateNews()
    assert news.is_news(SECOND, HERE, 10.0)
    assert not news.is_news(SECOND, HERE.copy(), 10.1)
    assert news.repeated == 10.1
    assert news.is_news(SECOND, THERE, 10.2)
    assert news.is_news(SECOND + 1, THERE, 10.3)
    assert news.repeated == 10.1


def test_without_a_stamp_nothing_is_known_to_be_repeated():
    news = StateNews()
    assert all(news.is_news(0, HERE, 0.1 * k) for k in range(5))


@pytest.mark.parametrize("behind", [0, SECOND // 100])  # the last tick of a clock may reach one node only
def test_a_device_at_rest_is_heard_while_the_clock_stands(behind):
    news, clock = StateNews(), 50 * SECOND
    assert news.is_news(clock - behind, HERE, 10.0, clock, 0.05)
    assert not news.is_news(clock - behind, HERE, 10.04, clock, 0.05)
    assert all(news.is_news(clock - behind, HERE, 10.06 + 0.01 * k, clock, 0.05) for k in range(100))


def test_a_driver_that_repeats_itself_is_noticed_under_a_clock_that_runs_or_that_made_not_its_stamps():
    news = StateNews()
    assert news.is_news(50 * SECOND, HERE, 10.0, 50 * SECOND, 0.05)
    for k in range(1, 100):
        assert not news.is_news(50 * SECOND, HERE, 10.0 + 0.01 * k, 50 * SECOND + k * SECOND // 100, 0.05)
    news = StateNews()
    assert news.is_news(50 * SECOND, HERE, 10.0, 0, 0.05)
    assert not any(news.is_news(50 * SECOND, HERE, 10.0 + 0.1 * k, 0, 0.05) for k in range(1, 100))
