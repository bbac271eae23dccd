"""Writes network_golden.hpp: a network's loss and its derivatives, and SOAP's steps, by numpy's dense algebra."""
import numpy as np

TARGETS, INPUTS, HIDDEN, SAMPLES = 3, 4, [5, 6], 7
CLAMP = 6.0


def wave(rows, cols, seed):
    """Numbers of either sign that both sides compute alike."""
    i, j = np.meshgrid(np.arange(rows), np.arange(cols), indexing="ij")
    return np.sin(1.7 * i + 2.3 * j + 0.9 * i * j + seed)


def make_layers():
    sizes = [INPUTS] + HIDDEN + [2 * TARGETS + TARGETS * (TARGETS - 1) // 2]
    return [(wave(out, before, k), wave(out, 1, 10 + k)[:, 0]) for k, (before, out) in enumerate(zip(sizes, sizes[1:]))]


def negative_log_density(head, t):
    """By the precision matrix, where nothing is clamped; works with complex numbers."""
    p = TARGETS
    A = np.eye(p, dtype=complex)
    A[np.tril_indices(p, -1)] = head[2 * p :]
    L = np.diag(np.exp(head[p : 2 * p])) @ A
    r = L.T @ (t - head[:p])
    size = np.where(r.real < 0, -r, r)
    rho = np.where(size.real <= CLAMP, r * r / 2, CLAMP * (size - CLAMP / 2))
    return rho.sum() - np.log(np.diag(L)).sum() + p * np.log(2 * np.pi) / 2


def loss(layers, x, y):
    offset, skip, scale = wave(TARGETS, 1, 20)[:, 0], wave(TARGETS, INPUTS, 21), 0.5 + wave(TARGETS, 1, 22)[:, 0] ** 2
    total = 0
    for n in range(SAMPLES):
        h = x[:, n].astype(complex)
        for W, b in layers[:-1]:
            a = W @ h + b
            h = a / (1 + np.exp(-a))
        W, b = layers[-1]
        total += negative_log_density(W @ h + b, (y[:, n] - offset - skip @ x[:, n]) / scale)
    return total


def derivatives(layers, x, y):
    """By complex steps."""
    found = []
    for k, (W, b) in enumerate(layers):
        for array in (W, b):
            gradient = np.zeros(array.shape)
            for index in np.ndindex(array.shape):
                changed = [[W.astype(complex), b.astype(complex)] for W, b in layers]
                changed[k][0 if array is W else 1][index] += 1e-30j
                gradient[index] = loss(changed, x, y).imag / 1e-30
            found.append(gradient)
    return found


def soap(rows, cols, largest_side, steps, interval):
    """Vyas et al. 2024, algorithm 3, the gradient's mean in its own space."""
    lr, beta1, beta2, eps, clamp = 0.1, 0.95, 0.95, 1e-8, 2.0
    W, A, B = wave(rows, cols, 1), wave(rows, rows, 2), wave(cols, cols, 3)
    M, V = np.zeros((rows, cols)), np.zeros((rows, cols))
    L = R = None
    for step in range(steps):
        G = A @ W @ B + wave(rows, cols, 4 + step)
        if step == 0:
            L, R = (1 - beta2) * G @ G.T, (1 - beta2) * G.T @ G
            QL = np.linalg.eigh(L)[1][:, ::-1] if rows <= largest_side else np.eye(rows)
            QR = np.linalg.eigh(R)[1][:, ::-1] if cols <= largest_side else np.eye(cols)
            continue
        turned = QL.T @ G @ QR
        M = beta1 * M + (1 - beta1) * G
        V = beta2 * V + (1 - beta2) * turned**2
        mean = (QL.T @ M @ QR) / (1 - beta1**step)
        N = np.clip(mean / (np.sqrt(V / (1 - beta2**step)) + eps), -clamp, clamp)
        W = W - lr * QL @ N @ QR.T
        L, R = beta2 * L + (1 - beta2) * G @ G.T, beta2 * R + (1 - beta2) * G.T @ G
        if step % interval == 0:
            if rows <= largest_side:
                order = np.argsort(-np.diag(QL.T @ L @ QL), kind="stable")
                QL, V = np.linalg.qr(L @ QL[:, order])[0], V[order]
            if cols <= largest_side:
                order = np.argsort(-np.diag(QR.T @ R @ QR), kind="stable")
                QR, V = np.linalg.qr(R @ QR[:, order])[0], V[:, order]
    return W


def show(values):
    return "{" + ", ".join(repr(float(v)) for v in np.ravel(values)) + "}"


def main():
    layers, x, y = make_layers(), wave(INPUTS, SAMPLES, 30), 3 * wave(TARGETS, SAMPLES, 31)
    print("#pragma once\n")
    print(f"// Written by make_network_golden.py (numpy {np.__version__}); matrices by rows.\n")
    print("#include <vector>\n\nnamespace twinmap::network::golden {\n")
    print(f"constexpr double kLoss = {float(loss(layers, x, y).real)!r};\n")
    print("// of weights and biases, layer by layer")
    print("inline const std::vector<std::vector<double>> kDerivatives{")
    print(",\n".join(show(gradient) for gradient in derivatives(layers, x, y)) + "};\n")
    print("// the weights after eleven gradients, the first of which only sets the bases")
    print(f"inline const std::vector<double> kSoapSquare{show(soap(6, 6, 100, 11, 3))};")
    print("// with the columns not turned")
    print(f"inline const std::vector<double> kSoapOneSide{show(soap(4, 7, 5, 11, 3))};\n")
    print("}  // namespace twinmap::network::golden")


main()
