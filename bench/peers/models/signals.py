"""Excitations that several models share."""
import numpy as np


def chirp(t, amplitude, first, last, end):
    """A sine whose frequency [Hz] grows linearly until `end` [s]; then 0."""
    return np.where(t < end, amplitude * np.sin(2 * np.pi * (first * t + (last - first) / (2 * end) * t**2)), 0.0)


def pulse(t, amplitude, start, end):
    return np.where((t >= start) & (t < end), amplitude, 0.0)
