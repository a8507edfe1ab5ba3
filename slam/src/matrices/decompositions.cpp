#include "matrices/decompositions.hpp"

template class Eigen::LLT<Eigen::Matrix<double, 3, 3>>;
template class Eigen::LLT<Eigen::Matrix<double, 6, 6>>;
template class Eigen::PartialPivLU<Eigen::Matrix<double, 3, 3>>;
template class Eigen::PartialPivLU<Eigen::Matrix<double, 6, 6>>;
template class Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 3, 3>>;
template class Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>>;
