import torch
from hypothesis import given
from hypothesis import strategies as st
from torch import nn

from training.autoencoder import build
from training.pixel_shuffle import with_pixel_shuffle


@given(
    kernel=st.sampled_from([3, 5, 7]),
    channels=st.tuples(st.integers(1, 4), st.integers(1, 4)),
    side=st.integers(1, 9),
    is_odd=st.booleans(),
    seed=st.integers(0, 99),
)
def test_a_shuffled_convolution_is_the_transposed_one(
    kernel: int, channels: tuple[int, int], side: int, is_odd: bool, seed: int
) -> None:
    torch.manual_seed(seed)
    transposed = nn.Sequential(nn.ConvTranspose2d(*channels, kernel, 2, kernel // 2, output_padding=1 - is_odd))
    values = torch.rand(2, channels[0], side, side)
    with torch.inference_mode():
        expected, shuffled = transposed(values), with_pixel_shuffle(transposed, least_kernel=3)(values)
    assert shuffled.shape == expected.shape
    torch.testing.assert_close(shuffled, expected, rtol=0.0, atol=1e-5)


def test_only_large_kernels_are_replaced_and_the_network_stays_as_it_was() -> None:
    for name, n_replaced in (("small_4x", 0), ("long_12x", 3)):
        network = build(name)
        before = [type(layer) for layer in network.decoder]
        shuffled = with_pixel_shuffle(network)
        assert sum(isinstance(layer, nn.ConvTranspose2d) for layer in network.modules()) - n_replaced == sum(
            isinstance(layer, nn.ConvTranspose2d) for layer in shuffled.modules()
        )
        assert [type(layer) for layer in network.decoder] == before
