#!/usr/bin/env python3
"""Compares two models of multiple scattering with random walks on the microfacets of a white metal.

usage: multiple_scattering.py [--walks N]

Walks follow E. Heitz et al. (Multiple-scattering microfacet BSDFs with the Smith model, 2016). The models are microtrace's lobe
(C. Kulla and A. Conty, Revisiting physically based shading at Imageworks, 2017) and single scattering, scaled such that no
energy is lost (E. Turquin, Practical multiple scattering compensation for microfacet models, 2019). For each roughness and
angle of incidence, prints the fraction of light that is scattered several times, and for both models the fraction of this
light that goes into other parts of the hemisphere than that of the walks: half the sum of the differences over 80 parts.
"""
import argparse

import numpy as np

random = np.random.default_rng(1)


def unit(v):
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def smith_lambda(w, alpha):
    """Returns Smith's Lambda of GGX, which is negative for directions below the surface."""
    sine = np.sqrt(np.maximum(1 - w[:, 2]**2, 1e-12))
    a = np.where(np.abs(w[:, 2]) < 1e-7, 1e-7, w[:, 2]) / (alpha * sine)
    return 0.5 * (np.sign(a) * np.sqrt(1 + 1 / a**2) - 1)


def visible_normals(w, alpha):
    """Samples normals visible from w (J. Dupuy and A. Benyoub, Sampling visible GGX normals with spherical caps, 2023)."""
    v = unit(w * [alpha, alpha, 1])
    z = (1 - random.random(len(w))) * (1 + v[:, 2]) - v[:, 2]
    radius, phi = np.sqrt(np.maximum(1 - z * z, 0)), 2 * np.pi * random.random(len(w))
    return unit(np.stack([alpha * (radius * np.cos(phi) + v[:, 0]), alpha * (radius * np.sin(phi) + v[:, 1]), z + v[:, 2]], 1))


def mirrored(w, normals):
    return 2 * (w * normals).sum(1, keepdims=True) * normals - w


def towards(theta, count):
    return np.repeat([[np.sin(theta), 0, np.cos(theta)]], count, 0)


def walks(theta, alpha, count):
    """Returns the directions in which light from theta leaves, and the number of its reflections."""
    w, height = -towards(theta, count), np.ones(count)  # heights are uniform in [0, 1]
    reflections, inside = np.zeros(count, int), np.arange(count)
    while len(inside) > 0:
        shape, u, below = smith_lambda(w[inside], alpha), random.random(len(inside)), height[inside]
        escapes = (w[inside, 2] > 0) & (u > 1 - below**np.maximum(shape, 0))
        inside, shape, u, below = inside[~escapes], shape[~escapes], u[~escapes], below[~escapes]
        shape = np.where(np.abs(shape) < 1e-9, 1e-9, shape)
        height[inside] = np.clip(below / np.maximum(1 - u, 1e-12)**(1 / shape), 1e-12, 1)
        w[inside] = mirrored(-w[inside], visible_normals(-w[inside], alpha))
        reflections[inside] += 1
    return w, reflections


def single_scattering(theta, alpha, count):
    """Returns sampled directions and their weights, whose mean is the albedo."""
    wo = towards(theta, count)
    wi = mirrored(wo, visible_normals(wo, alpha))
    here = 1 + smith_lambda(wo, alpha)
    is_above = wi[:, 2] > 0
    there = smith_lambda(np.where(is_above[:, None], wi, [[0, 0, 1]]), alpha)
    return wi, np.where(is_above, here / (here + there), 0)


def histogram(directions, weights):
    azimuth = np.abs(np.arctan2(directions[:, 1], directions[:, 0]))
    parts = np.histogram2d(np.clip(directions[:, 2], 0, 1), azimuth, [10, 8], [[0, 1], [0, np.pi]], weights=weights)[0]
    return parts / len(directions)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--walks", type=int, default=600_000)
    count = parser.parse_args().walks
    print("roughness  theta  several times  Kulla and Conty  Turquin")
    for roughness in (0.5, 0.75, 1):
        alpha = roughness**2
        cosines = (np.arange(40) + 0.5) / 40
        albedos = np.array([single_scattering(np.arccos(z), alpha, 20_000)[1].mean() for z in cosines])
        mean = (2 * cosines * albedos).mean()
        for theta in (0.05, 0.6, 1, 1.35):
            directions, reflections = walks(theta, alpha, count)
            wanted = histogram(directions, (reflections > 1).astype(float))
            wi, weights = single_scattering(theta, alpha, count)
            lost = 1 - weights.mean()
            scaled = histogram(wi, weights * lost / (1 - lost))
            z, phi = np.sqrt(random.random(count)), 2 * np.pi * random.random(count)  # cosine-distributed
            spread = np.stack([np.sqrt(1 - z * z) * np.cos(phi), np.sqrt(1 - z * z) * np.sin(phi), z], 1)
            lobe = histogram(spread, lost * (1 - np.interp(z, cosines, albedos)) / (1 - mean))
            kulla, turquin = (0.5 * np.abs(wanted - x).sum() / wanted.sum() for x in (lobe, scaled))
            print(f"{roughness:9.2f} {theta:6.2f} {wanted.sum():14.3f} {kulla:16.3f} {turquin:8.3f}")


if __name__ == "__main__":
    main()
