#!/usr/bin/env python3
"""Writes the accelerogram of studies/own-earthquake: t (s), a (m/s²), every 0.01 s for 12 s, largest |a| 3 m/s².

Sines from 1 to 25 Hz with drawn phases under an envelope that rises in 2 s and fades from 6 s on. The draw is a linear
congruential generator (Knuth, MMIX), so that the file is the same everywhere.
"""
import math
import sys

state = 20240607


def drawn():
    global state
    state = (6364136223846793005 * state + 1442695040888963407) % 2**64
    return (state >> 11) * 2.0**-53


lines = [(1 + 0.2 * k, 2 * math.pi * drawn()) for k in range(121)]


def envelope(t):
    return min(1.0, (t / 2) ** 2) * (1.0 if t < 6 else math.exp(-0.6 * (t - 6)))


times = [0.01 * i for i in range(1201)]
raw = [
    envelope(t) * sum(math.cos(2 * math.pi * f * t + phase) / math.sqrt(f) for f, phase in lines) if t < 12 else 0.0
    for t in times
]
peak = max(abs(a) for a in raw)
with open(sys.argv[1] if len(sys.argv) > 1 else "studies/own-earthquake/ground.csv", "w", encoding="ascii") as out:
    out.write("t,a\n")
    for t, a in zip(times, raw):
        out.write(f"{t:.2f},{3 * a / peak + 0.0:.4f}\n")
