# SPDX-License-Identifier: BSD-3-Clause
# The program in an image, built by the scripts that build it anywhere.
#   docker build -t masked_mapper .
#   docker run --rm -v "$PWD:/data" masked_mapper map log.clf.gz -o out
ARG SYSTEM=debian:12
FROM ${SYSTEM} AS build
WORKDIR /masked_mapper
# First what seldom changes, so that a change of the sources installs nothing anew.
COPY scripts/setup.sh scripts/install_packages.sh scripts/
RUN scripts/setup.sh --build-only && scripts/install_packages.sh dpkg-dev file
COPY . .
RUN scripts/package.sh /packages

FROM ${SYSTEM}
COPY --from=build /packages/masked-mapper_*.deb /tmp/
RUN apt-get update && \
    apt-get install -y --no-install-recommends /tmp/masked-mapper_*.deb && \
    rm -rf /tmp/*.deb /var/lib/apt/lists/*
WORKDIR /data
ENTRYPOINT ["masked_mapper"]
